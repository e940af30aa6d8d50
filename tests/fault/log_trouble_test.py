#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A log that is deleted, full or not writable: it is said with cause and cure, storing goes on by itself, and nothing flies
whose telecommands could not be found again."""
import pathlib
import subprocess
import tempfile
import unittest

import flight


def covered(records):
    """How many numbers these records stand for: one each, and what their gaps have lost."""
    return sum(int(record["text"].split(" records lost")[0].split()[-1]) if record["kind"] == "gap" else 1 for record in records)


class LogTrouble(unittest.TestCase):
    def test_a_log_deleted_in_flight_is_told_and_begun_anew(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            begin = rokviss.count()
            for path in (rokviss.folder / "log").iterdir():
                path.unlink(missing_ok=True)  # SQLite takes its files beside the log away itself
            rokviss.wait_told("was deleted or moved", 5.0, begin)
            rokviss.wait_told("SUPERVISOR medium LOG_STORE", 5.0, begin)
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)
            records = rokviss.log()
            self.assertEqual((records[0]["kind"], records[0]["number"]), ("gap", 1), "what went with it is counted")
            numbers = [record["number"] for record in records]
            lost = int(records[0]["text"].split(" records lost")[0].split()[-1])
            self.assertEqual(numbers[1], lost + 1)
            self.assertEqual(numbers[1:], list(range(lost + 1, numbers[-1] + 1)))

    def test_a_full_disk_is_told_and_storing_resumes_when_there_is_space(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-full-") as folder:
            disk = pathlib.Path(folder) / "log"
            disk.mkdir()
            if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=6m", "none", str(disk)], capture_output=True,
                              check=False).returncode != 0:
                flight.skip("no-mount")
            try:
                with flight.Flight(folder=folder) as rokviss:
                    rokviss.wait_commissioned()
                    begin = rokviss.count()
                    filler = disk / "filler"
                    with self.assertRaises(OSError), open(filler, "wb", buffering=0) as file:
                        while True:
                            file.write(bytes(4096))
                    rokviss.wait_told("no space for log", 20.0, begin)
                    # A flight goes on without a log, and another supervisor with the flight.
                    begin = rokviss.count()
                    rokviss.kill("hirosco-supervisor")
                    rokviss.wait_told("goes on with MANIPULATOR", 2.0, begin)
                    rokviss.wait_told("no space for log", 20.0, begin)
                    begin = rokviss.count()
                    filler.unlink()
                    rokviss.wait_told("log storage works", 10.0, begin)
                    rokviss.wait_told("SUPERVISOR low LOG_RESUMED", 5.0, begin)
                    self.assertEqual(rokviss.tc("manipulator", "SET_STATE", "SafeOperational")[0], 0)
                    self.assertEqual(rokviss.end(), 0, rokviss.errors)
                    records = rokviss.log()
                    self.assertEqual(covered(records), records[-1]["number"])
            finally:
                subprocess.run(["umount", "-l", str(disk)], capture_output=True, check=False)

    def test_the_database_that_a_telecommand_has_chosen_outlives_the_supervisor(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.assertEqual(rokviss.tc("supervisor", "SET_DATABASE", "ascii")[0], 0)
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
            begin = rokviss.count()
            rokviss.kill("hirosco-supervisor")
            rokviss.wait_told("goes on with MANIPULATOR", 2.0, begin)
            self.assertEqual(rokviss.tc("manipulator", "ping")[0], 0)
            self.assertEqual(rokviss.end(), 0, rokviss.errors)
            pieces = sorted(path.name for path in (rokviss.folder / "log").iterdir() if ".2" in path.name or ".3" in path.name)
            self.assertEqual([pathlib.Path(name).suffix for name in pieces], [".log"], "one piece of text, and nothing behind it")
            records = rokviss.log()
            self.assertEqual(records[-1]["number"], covered(records), "who is killed may lose some, which are counted")

    def test_nothing_flies_without_a_log(self):
        with tempfile.TemporaryDirectory(prefix="hirosco-nolog-") as folder:
            (pathlib.Path(folder) / "log").write_text("a file where the folder should be")
            done = subprocess.run([str(flight.BINARIES / "hirosco"), "run", str(flight.ROKVISS), "--no-ground"], cwd=folder,
                                  env={**flight.os.environ, "XDG_RUNTIME_DIR": folder}, stdin=subprocess.DEVNULL,
                                  capture_output=True, text=True, timeout=30, check=False)
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertIn("no flight without a log", done.stderr)
            self.assertIn("cannot be written", done.stderr)


if __name__ == "__main__":
    flight.main()
