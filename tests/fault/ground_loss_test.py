#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The loss of the ground, with real processes: in one mode it is noted and the imager goes on turning, in another it comes to rest; so again
after it was brought back. And with the process that carries the ground link, which dies under a station that does not come back. Judged at the device."""
import pathlib
import signal
import time
import unittest

import flight

MISSION = pathlib.Path(__file__).resolve().parent / "ground_loss.xml"
LOST = "COMMUNICATION medium GROUND_LINK_LOST"
TOLD_BY_SUPERVISOR = "SUPERVISOR medium GROUND_LINK_LOST APID=2"
REACTION = "plan ground-lost-near: IMAGER to SafeOperational because of GROUND_LINK_LOST"
# At 0.2 rad/s each way takes longer than the ground is waited for, 2 s.
THERE, BACK = 1.0, -1.0


class GroundLoss(unittest.TestCase):
    def wait_truth(self, craft, wanted, seconds):
        end = time.monotonic() + seconds
        while not wanted(truth := craft.truth("imager")):
            self.assertLess(time.monotonic(), end, truth)
            time.sleep(0.005)
        return truth

    def loses_the_ground_while_it_turns(self, craft, angle, before=()):
        """The line that tells of it; `before`: telecommands of an operator who is there until then."""
        with flight.Telemetry():
            for words in before:
                self.assertEqual(craft.tc(*words)[0], 0, words)
            self.assertEqual(craft.tc("IMAGER", "POINT", angle)[0], 0)
            self.wait_truth(craft, lambda truth: truth["moves"] == 1.0, 2.0)
            begin = craft.count()
        return begin, craft.wait_told(LOST, 6.0, begin)

    def comes_to_rest(self, craft, begin, lost, end=BACK):
        craft.wait_told(REACTION, 2.0, begin)
        self.wait_truth(craft, lambda truth: truth["moves"] == 0.0, 2.0)
        flight.measure(f"at rest {time.monotonic() - lost.received:.3f} s after the loss was told")
        held = craft.truth("imager")["angle"]
        time.sleep(0.5)
        self.assertEqual(craft.truth("imager")["angle"], held)
        self.assertGreater(abs(held - end), 0.1, "it came to rest because it had arrived")
        craft.wait_told("IMAGER info STATE_CHANGED STATE=SafeOperational", 2.0, begin)

    def test_far_away_it_is_noted_and_nearby_the_imager_comes_to_rest(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode far", 20.0)
            begin, _ = self.loses_the_ground_while_it_turns(craft, THERE)
            first = craft.truth("imager")
            time.sleep(0.5)
            later = craft.truth("imager")
            self.assertEqual(later["moves"], 1.0)
            self.assertGreater(later["angle"], first["angle"])
            self.assertFalse([line.told for line in craft.told(begin) if line.told.startswith("plan ")])

            begin, lost = self.loses_the_ground_while_it_turns(craft, BACK, [("SUPERVISOR", "SET_MODE", 3)])
            self.comes_to_rest(craft, begin, lost)

            # The operator is back, brings it up in the ordinary way, and is lost again.
            begin, lost = self.loses_the_ground_while_it_turns(craft, BACK, [("IMAGER", "SET_STATE", 5)])
            self.comes_to_rest(craft, begin, lost)
            self.assertEqual(craft.end(), 0)

    def kills_the_ground_link_while_it_turns(self, craft, angle, number=signal.SIGKILL):
        """When, and the place in the story. Its station is there until then: the process that was killed had somebody, the next one has nobody."""
        with flight.Telemetry():
            self.assertEqual(craft.tc("IMAGER", "POINT", angle)[0], 0)
            self.wait_truth(craft, lambda truth: truth["moves"] == 1.0, 2.0)
            begin = craft.count()
            killed = craft.kill("hirosco-communication", number)
        return begin, killed

    def test_with_the_process_of_the_ground_link_the_ground_is_lost_as_well(self):
        with flight.Flight(MISSION) as craft:
            craft.wait_told("commissioned: mode far", 20.0)
            self.assertEqual(craft.tc("SUPERVISOR", "SET_MODE", 3)[0], 0)

            # It dies, and is there again before anybody is missed: nobody comes back to it.
            begin, killed = self.kills_the_ground_link_while_it_turns(craft, THERE)
            craft.wait_told("COMMUNICATION died: signal 9", 2.0, begin)
            craft.wait_told("the ground link is back", 2.0, begin)
            self.assertEqual(craft.truth("imager")["moves"], 1.0, "nobody is missed yet")
            lost = craft.wait_told(TOLD_BY_SUPERVISOR, 4.0, begin)
            flight.measure(f"told {lost.received - killed:.3f} s after the ground link was killed")
            self.assertGreater(lost.received - killed, 1.9)
            self.comes_to_rest(craft, begin, lost, THERE)
            self.assertFalse([line.told for line in craft.told(begin) if LOST in line.told], "who is new has never had anybody")

            # It stands still, is ended for that and comes back.
            self.assertEqual(craft.tc("IMAGER", "SET_STATE", 5)[0], 0)
            begin, _ = self.kills_the_ground_link_while_it_turns(craft, BACK, signal.SIGSTOP)
            craft.wait_told("COMMUNICATION hangs", 5.0, begin)
            self.comes_to_rest(craft, begin, craft.wait_told(TOLD_BY_SUPERVISOR, 6.0, begin))
            craft.wait_told("the ground link is back", 6.0, begin)
            self.assertEqual(craft.tc("IMAGER", "SET_STATE", 5)[0], 0, "the ground commands again")
            self.assertIn(craft.end(), (0, 5), "5: of high severity, longer after a telecommand than what that may have caused")


if __name__ == "__main__":
    flight.main()
