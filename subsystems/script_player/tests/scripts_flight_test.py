#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Scripts with real processes, the player in its sandbox: one is played to its end, one is refused half-way with the reason to who
played it, one is held, resumed and aborted."""
import pathlib
import threading
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parent / "mission.xml"


class Scripts(unittest.TestCase):
    def play(self, craft, script):
        return craft.hirosco("tc", "PLAYER", "PLAY", script, "--mission", str(MISSION))

    def test_they_are_played_held_and_stopped_with_the_reason(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode operation", 20.0)
            begun = time.monotonic()
            played = self.play(craft, "THERE_AND_BACK")
            self.assertEqual(played.returncode, 0, played.stdout + played.stderr)
            flight.measure(f"there and back in {time.monotonic() - begun:.1f} s")

            refused = self.play(craft, "TOO_FAR")
            self.assertNotEqual(refused.returncode, 0)
            self.assertIn("line 6: HELLO MOVE_TO: joint limit", refused.stdout)

            begin = craft.count()
            said = []
            playing = threading.Thread(target=lambda: said.append(self.play(craft, "THERE_AND_BACK")))
            playing.start()
            craft.wait_told("SCRIPT_BEGUN", 5.0, begin)
            for function in ("HOLD", "RESUME", "ABORT"):
                self.assertEqual(craft.tc("PLAYER", function)[0], 0, function)
            playing.join()
            self.assertNotEqual(said[0].returncode, 0)
            self.assertIn("aborted in line", said[0].stdout)
            self.assertNotEqual(craft.tc("PLAYER", "ABORT")[0], 0)
            craft.end()


if __name__ == "__main__":
    flight.main()
