#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Ground stations that share no line with the project, one honest and one hostile, against a real flight."""
import pathlib
import subprocess
import sys
import unittest

import flight

CLIENT = flight.REPOSITORY / "tests/client"
sys.path.insert(0, str(CLIENT))
import with_library  # noqa: E402  (found by the line above)


class ForeignGround(unittest.TestCase):
    def test_an_honest_one_is_served_and_a_hostile_one_harms_nobody(self):
        with flight.Flight() as rokviss:
            rokviss.wait_commissioned()
            self.passes("ground_client.py", "--listen", "2")
            before = rokviss.processes()
            self.passes("hostile.py", "--quick")
            self.assertEqual(rokviss.processes(), before, "the same processes as before the storm")
            self.assertEqual(rokviss.end(), 0, rokviss.errors)

    def passes(self, script, *arguments):
        done = subprocess.run([python, "-B", str(CLIENT / script), "--mission", str(flight.ROKVISS), *arguments],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              timeout=100, check=False)
        flight.measure(f"{script}\n{done.stdout}")
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    python, reason = with_library.interpreter(pathlib.Path(flight.BINARIES).parent / "python_judges")
    if python is None:
        flight.skip("no-package-index-of-python", reason)
    flight.main()
