#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""docs/interfaces/computer.md names the system calls that the sandbox refuses, each with its error number, and the words of the list of flights, as the code has
them. Prints what differs, and takes a row away from a copy itself, to be caught."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE, CALLS, REGISTRY = "docs/interfaces/computer.md", "hirosco/utilities/os/linux/sandbox_calls.cpp", "tools/hirosco/flight_registry.cpp"
OF_THE_FILTER = {"syscall"}


def table(page, mark):
    """Rows of the table behind a mark, without its head."""
    block = page.partition(f"<!-- {mark} -->\n")[2].partition("\n\n")[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in block.splitlines()[2:]]


def refused(code):
    """{system call: errno} of the filter."""
    named = dict.fromkeys(re.findall(r"\bSYS_(\w+)", code), "EPERM")
    named.update(dict.fromkeys(re.findall(r'calls_of_later_kernels\[\d\], "(\w+)"', code), "EPERM"))
    named.update({call: errno for call, errno in re.findall(r"SYS_(\w+), 0, 1\);\s*made\.add\(bpf_answer, SECCOMP_RET_ERRNO \| (\w+)\)", code)})
    return {call: errno for call, errno in named.items() if call not in OF_THE_FILTER}


def problems(page, calls, registry):
    wanted = refused(calls)
    told = [(call, row[2]) for row in table(page, "refusals") for call in row[0].split(", ")]
    yield from (f"{PAGE}: the sandbox is about {call}, of which it has no row" for call in wanted if call not in dict(told))
    yield from (f"{PAGE}: the sandbox is not about {call}" for call, _ in told if call not in wanted)
    yield from (f"{PAGE}: {call} fails with {wanted[call]}, not {errno}" for call, errno in told if wanted.get(call, errno) != errno)
    yield from (f"{PAGE}: {call} stands there twice" for call in sorted({call for call, _ in told}) if sum(one == call for one, _ in told) > 1)
    words, listed = re.findall(r'name == "(\w+)"', registry), [row[0] for row in table(page, "registry")]
    yield from (f"{PAGE}: a flight's file has {word}, of which it has no row" for word in words if word not in listed)
    yield from (f"{PAGE}: no flight's file has {word}" for word in listed if word not in words)


def main():
    page, calls, registry = ((ROOT / path).read_text() for path in (PAGE, CALLS, REGISTRY))
    found = list(problems(page, calls, registry))
    for wanted, changed in (("about kcmp, of which", (page.replace("kcmp, ", ""), calls)), ("not about kcmp", (page, calls.replace("SYS_kcmp", "SYS_ptrace"))),
                            ("clone3 fails with ENOSYS", (page.replace("| clone3 | always | ENOSYS |", "| clone3 | always | EPERM |"), calls)),
                            ("file has keeper", (page.replace("| keeper |", "| kept |"), calls)), ("listen stands there twice", (page.replace("| listen |", "| listen, listen |"), calls))):
        if not any(wanted in what for what in problems(*changed, registry)):
            found.append(f"planted and not seen: {wanted}")
    return "\n".join(found) or None


if __name__ == "__main__":
    sys.exit(main())
