# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Two flights of one mission on one computer, each with the page that `hirosco run --instance NAME` starts beside it
(docs/adr/0037): what one page shows, commands, breaks and keeps is its own flight's. Python's standard library only."""
import contextlib
import json
import pathlib
import tempfile
import time
import unittest
import urllib.request

import flight


class Page:
    """The page of a flight, at the address that the flight tells."""

    def __init__(self, craft):
        line = craft.wait_line(lambda l: "url" in l.content, 10.0)
        if line is None:
            raise AssertionError("it does not say where its page is")
        self.url, self.token = line.content["url"].split("/#token=")

    def ask(self, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.url + path, data, {"Authorization": f"Bearer {self.token}"})
        with urllib.request.urlopen(request, timeout=10) as answer:
            return json.loads(answer.read())

    def until(self, path, condition, limit_s=15.0):
        end = time.monotonic() + limit_s
        while not condition(answer := self.ask(path)):
            if time.monotonic() > end:
                raise AssertionError(f"not within {limit_s} s: {path}: {answer}")
            time.sleep(0.05)
        return answer

    def command(self, subsystem, function, **arguments):
        """The newest report of a telecommand that is through."""
        sent = self.ask("/api/commands", {"subsystem": subsystem, "function": function, "arguments": arguments})

        def newest(answer):
            return next(one for one in answer["commands"] if one["id"] == sent["id"])
        return newest(self.until("/api/commands", lambda answer: newest(answer)["stage"] in ("completed", "failed")))

    def states(self):
        return {one["name"]: one["state"] for one in self.ask("/api/status")["subsystems"]}


def inhibited(status):
    return [one["name"] for one in status["subsystems"] if one["inhibited"]]


@contextlib.contextmanager
def two_flights():
    with tempfile.TemporaryDirectory(prefix="hirosco-flights-") as folder, \
            flight.Flight(folder=folder, instance="one", more=()) as one:
        one.wait_commissioned()
        with flight.Flight(folder=folder, instance="two", more=()) as two:
            two.wait_commissioned()
            yield one, two


class TwoPages(unittest.TestCase):
    def test_each_page_shows_commands_breaks_and_keeps_what_is_its_own(self):
        with two_flights() as crafts:
            pages = [Page(craft) for craft in crafts]
            self.assertNotEqual(pages[0].url, pages[1].url)
            for page in pages:
                page.until("/api/status", lambda status: status["link"]["connected"] and status["mode"] == "telepresence")

            # One page's telecommand is heard by its flight alone, and the other page knows nothing of it.
            self.assertEqual(pages[0].command("MANIPULATOR", "SET_TORQUE_LIMIT", LIMIT=11)["stage"], "completed")
            heard = [[record for record in craft.log() if "SET_TORQUE_LIMIT" in record["text"]] for craft in crafts]
            self.assertTrue(heard[0])
            self.assertFalse(heard[1])
            self.assertEqual(pages[1].ask("/api/commands")["commands"], [])

            # So are the faults of simulated devices, what they bring about, and its story.
            pages[1].ask("/api/faults", {"device": "joystick", "line": "unplug"})
            crafts[1].wait_told("JOYSTICK_LOST")
            told = pages[1].until("/api/why", lambda why: why["causes"])
            self.assertTrue(told["title"].startswith("JOYSTICK lost its device"), told["title"])
            self.assertEqual(pages[0].ask("/api/why")["causes"], [])
            self.assertEqual(set(pages[0].states().values()), {"Operational"})

            # SAFE_ALL leaves by a connection of its own: to the ports of its own flight.
            self.assertEqual(pages[0].command("SUPERVISOR", "SAFE_ALL")["stage"], "completed")
            stopped = pages[0].until("/api/status", lambda status: {"MANIPULATOR", "JOYSTICK"} <= set(inhibited(status)))
            self.assertEqual(stopped["mode"], "telepresence")
            for craft, calls in zip(crafts, (1, 0)):
                self.assertEqual(len([line for line in craft.told() if "SAFE_ALL: every actuator" in line.told]), calls)

            archives = {pathlib.Path(craft.place()["log"]).with_name(
                pathlib.Path(craft.place()["log"]).stem + "-ground.db") for craft in crafts}
            self.assertEqual(len(archives), 2)
            for archive in archives:
                self.assertTrue(archive.is_file(), archive)
            for craft in crafts:
                craft.end()


if __name__ == "__main__":
    flight.main()
