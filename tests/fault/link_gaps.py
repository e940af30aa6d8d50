# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What real_campaign.py demands of the links between subsystems while there is no supervisor: none has a gap. How many cycles
in a row have no new sample, the page of whoever uses them shows; how many may have none says its descriptor."""
import xml.etree.ElementTree as xml

import flight
import pages
from demands import Demands, expect

PERIOD_S = 0.00025                  # of looks: two in a cycle, so that hardly one is missed
CYCLE_S = 0.0005
COUPLED, LINKS = 2, (1, 2)          # the configuration of both ends, and the links between them


def age_limit(mission, link, configuration, realtime):
    """In cycles of the consumer of link `link`, in its configuration of this number. Both ends of what flies here sample equally fast."""
    root = xml.parse(mission).getroot()
    consumer, required = next(each.get("to").split(".") for each in root.findall("Links/Link") if int(each.get("id")) == link)
    for subsystem in root.findall("Subsystem"):
        descriptor = xml.parse(mission.parent / subsystem.get("descriptor")).getroot()
        if subsystem.get("name", descriptor.get("name")) == consumer:
            of = next(each for each in descriptor.iter("Configuration") if int(each.get("id")) == configuration)
            wanted = next(each for each in of.iter("Requires") if each.get("name") == required)
            return int(wanted.get("age" if realtime else "age_reduced"))
    raise AssertionError(f"link {link} of {mission} leads to nobody")


def row(limit):
    return f"link gap, {limit} cycles permitted"


DEADLINES_S = {row(limit): limit * CYCLE_S
               for limit in sorted({age_limit(flight.ROKVISS, link, COUPLED, realtime) for link in LINKS for realtime in (True, False)})}


def watched(craft, programs):
    return pages.Watch(craft, programs, PERIOD_S)


class LinkGaps(Demands):
    def no_link_had_a_gap(self, watch, programs, begin, end):
        """From `begin` to `end`, in cycles of whoever uses what comes."""
        late = self.late_s(watch, begin, end)
        for program in programs:
            vital = watch.vital(program)
            expect(watch.gaps[program], f"{program} has no link")
            expect(not watch.stale[program], f"{program} took link {watch.stale[program]} for stale without a supervisor")
            for link, cycles in watch.gaps[program].items():
                limit = age_limit(flight.ROKVISS, link, vital.configuration(), vital.realtime())
                expect(cycles * CYCLE_S <= DEADLINES_S[row(limit)] + late,
                       f"link {link} had nothing new for {cycles} cycles of {program}, which permits {limit}")
                self.took(row(limit), cycles * CYCLE_S)
