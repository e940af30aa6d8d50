# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A simulated flight says what its octets rest on, and who compares two of them does not compare what may differ."""
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
HIROSCO = pathlib.Path(os.environ.get("HIROSCO_BIN", REPOSITORY / "build/fly/bin")) / "hirosco"
sys.path.insert(0, str(REPOSITORY / "bench"))
import same_octets  # noqa: E402  beside bench/compare, which uses it

ORIGIN = {"hirosco": "7.8.9", "architecture": "x86_64", "c_library": "glibc-2.36", "engines": "MuJoCo-4.0.0", "mission": "M", "seed": "1"}


def flight(*lines, mark="# simulated: ", **differs):
    return [mark + " ".join(f"{key}={value}" for key, value in {**ORIGIN, **differs}.items()), *lines]


class SameOctets(unittest.TestCase):
    def compared(self, one, other):
        return same_octets.compare(one, other, ("old", "new"))

    def test_flights_of_one_origin_are_compared_line_by_line(self):
        self.assertEqual(self.compared(flight("a", "b"), flight("a", "b")), (same_octets.SAME, "the same octets: 2 lines"))
        how, told = self.compared(flight("a", "b"), flight("a", "c"))
        self.assertEqual(how, same_octets.OTHER)
        self.assertIn("differs at line 2 of 2 and 2", told)
        self.assertIn("new: c", told)
        self.assertIn("new: has ended", self.compared(flight("a", "b"), flight("a"))[1])
        self.assertEqual(self.compared(flight("a", mark="0 simulated "), flight("a", mark="0 simulated "))[0], same_octets.SAME)

    def test_another_version_of_what_is_compared_is_no_reason_to_refuse(self):
        self.assertEqual(self.compared(flight("a"), flight("a", hirosco="7.9.0"))[0], same_octets.SAME)

    def test_whatever_else_they_rest_on_is_refused_by_its_name_when_it_differs(self):
        for key, other in (("engines", "MuJoCo-4.1.0"), ("architecture", "aarch64"), ("c_library", "glibc-2.41"), ("mission", "N"), ("seed", "2")):
            with self.subTest(key):
                how, told = self.compared(flight("a"), flight("a", **{key: other}))
                self.assertEqual(how, same_octets.REFUSED)
                self.assertIn(f"{key} {ORIGIN[key]} and {other}", told)
        without = flight("a")
        without[0] = without[0].replace(" engines=MuJoCo-4.0.0", "")
        self.assertIn("engines none and MuJoCo-4.0.0", self.compared(without, flight("a"))[1])

    def test_a_flight_that_says_nothing_of_it_is_compared_and_that_is_said(self):
        how, told = self.compared(["a"], flight("a"))
        self.assertEqual(how, same_octets.SAME)
        self.assertIn("old does not say what its octets rest on", told)
        self.assertEqual(self.compared([], [])[0], same_octets.REFUSED)

    def test_a_simulated_flight_says_it_in_log_and_trace_and_is_the_same_twice(self):
        with tempfile.TemporaryDirectory() as folder:
            logs = []
            for number in "12":
                words = [HIROSCO, "simulate", "rokviss", "--for", "0.5s", "--seed", "7", "--octets", "--trace", f"{folder}/{number}.csv"]
                done = subprocess.run(words, cwd=REPOSITORY, capture_output=True, text=True, check=False)
                logs.append(done.stdout.splitlines())
                said, rows = same_octets.origin(pathlib.Path(folder, f"{number}.csv").read_text(encoding="ascii").splitlines())
                self.assertEqual(said, same_octets.origin(logs[-1])[0])
                self.assertEqual(said["architecture"], platform.machine())
                self.assertEqual((said["mission"], said["seed"], said["engines"]), ("ROKVISS", "7", "none"))
                self.assertTrue(rows[0].startswith("t_s,"), rows[0])
            self.assertEqual(self.compared(*logs)[0], same_octets.SAME)
            done = subprocess.run([REPOSITORY / "bench/same_octets.py", f"{folder}/1.csv", f"{folder}/2.csv"], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout[:16]), (0, "the same octets:"))
            self.assertEqual(subprocess.run([REPOSITORY / "bench/same_octets.py", f"{folder}/1.csv", f"{folder}/none"], capture_output=True, check=False).returncode, 2)


if __name__ == "__main__":
    unittest.main()
