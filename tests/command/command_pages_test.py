# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Every command, argument and option that `--help` shows is in the man page and in the completion of bash, with its words."""
import os
import pathlib
import re
import subprocess
import unittest

BIN = pathlib.Path(os.environ["HIROSCO_BIN"])
SHARE = BIN.parent / "share"
COMPLETE = """
source "$1"; shift
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); compopt() { :; }
_hirosco
printf '%s\\n' "${COMPREPLY[@]}"
"""


def helped(*words):
    """What it shows of a command: names of commands below, of options and of arguments, each with its description."""
    text = subprocess.run([BIN / "hirosco", *words, "--help"], capture_output=True, text=True, check=True).stdout
    found, part, last = {"Subcommands": {}, "Options": {}, "Positionals": {}}, "", None
    for line in text.splitlines():
        if heading := re.fullmatch(r"(Subcommands|Options|Positionals):", line):
            part = heading[1]
        elif line and not line.startswith(" "):
            part = ""  # what stands below the options
        elif part and (row := re.match(r"  (-?\S+)(.*)", line)):
            last = row[1].rstrip(",")
            found[part][last] = row[2]
        elif part and last and line.startswith("     "):
            found[part][last] += "  " + line.strip()
    return found


def every_command():
    ways = [()]
    for way in ways:
        shown = helped(*way)
        yield way, shown
        ways.extend((*way, name) for name in shown["Subcommands"])


class CommandPages(unittest.TestCase):
    def test_the_man_page_has_every_command_and_option_with_its_words(self):
        page = (SHARE / "man/man1/hirosco.1").read_text().replace("\\-", "-").replace("\\e", "\\").replace("\\&", "")
        parts = dict(re.findall(r"(?ms)^\.SS (hirosco[^\n]*)\n(.*?)(?=^\.S[SH] |\Z)", page))
        parts["hirosco"] = re.search(r"(?ms)^\.SH OPTIONS\n(.*?)^\.SH", page)[1]
        options = 0
        for way, shown in every_command():
            name = " ".join(("hirosco", *way))
            self.assertIn(name, parts)
            flat = " ".join(parts[name].split())
            for part in ("Options", "Positionals"):
                for word, description in shown[part].items():
                    options += 1
                    self.assertRegex(parts[name], rf"(?m)^\.B (-h, )?{re.escape(word.split(',')[-1])}\b", name)
                    # Behind types and marks the words are the last thing in the line of help.
                    self.assertIn(" ".join(re.split(r"\s{2,}", description)[-1].split())[-20:], flat, f"{name} {word}")
        self.assertGreater(options, 80)

    def test_bash_completes_every_command_and_option(self):
        completion = SHARE / "bash-completion/completions/hirosco"
        asked = 0
        for way, shown in every_command():
            told = self.completed(completion, *way, "")
            for word in shown["Subcommands"]:
                self.assertIn(word, told)
            told = self.completed(completion, *way, "-")
            for word in shown["Options"]:
                asked += 1
                self.assertIn(word.split(",")[-1], told, way)
        self.assertGreater(asked, 60)

    def test_bash_completes_missions_and_files(self):
        completion = SHARE / "bash-completion/completions/hirosco"
        self.assertIn("rokviss", self.completed(completion, "run", "rok"))
        self.assertIn("rokviss", self.completed(completion, "export", "python", ""))
        self.assertIn("rokviss", self.completed(completion, "status", "--mission", "rok"))
        self.assertNotIn("rokviss", self.completed(completion, "tc", ""))
        self.assertIn(str(completion), self.completed(completion, "simulate", "--trace", str(completion)[:-2]))
        self.assertEqual([], self.completed(completion, "nonsen"))

    def completed(self, completion, *words):
        done = subprocess.run(["bash", "-c", COMPLETE, "bash", completion, BIN / "hirosco", *words], capture_output=True, text=True, check=True)
        self.assertEqual(done.stderr, "")
        return done.stdout.split()


if __name__ == "__main__":
    unittest.main()
