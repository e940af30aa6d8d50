# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""How many cycles in a row a subsystem missed while something went on beside it, and how many it may: as many late ones in a row as its
configuration names raise CYCLE_OVERRUNS and end what it does. Python's standard library only."""
import contextlib
import math
import os
import time
import xml.etree.ElementTree as xml

import pages

PERIOD_S = 0.00025            # of looks: two in the shortest cycle that flies here
OVERRUNS, OVERRUNS_REDUCED = 3, 20      # docs/interfaces/schema.md, where a descriptor says nothing


def limit_of(descriptor, configuration, realtime):
    """So many in a row end it."""
    of = next(each for each in xml.parse(descriptor).iter("Configuration") if int(each.get("id")) == configuration)
    limit = int(of.get("overruns", OVERRUNS))
    return limit if realtime else int(of.get("overruns_reduced", max(limit, OVERRUNS_REDUCED)))


def in_a_row(rows, pauses, cycle_s):
    """The most that a subsystem missed in a row by itself. `rows`: [(when it was seen, how many)], `pauses`: [(begin, end)] of the processor on
    which all cycles are (docs/adr/0007): who misses the cycles of a pause does not miss them by himself."""
    worst = 0
    for at, missed in rows:
        begin = at - (missed + 2) * cycle_s - PERIOD_S
        paused_s = sum(max(0.0, min(till, at) - max(since, begin)) for since, till in pauses)
        worst = max(worst, missed - math.ceil(paused_s / cycle_s))
    return worst


class Missed(pages.Beside):
    """`with Missed(pid) as missed:` — until the end of the block a process above all cycles, on their processor, looks at the page of this one.
    Afterwards: in_a_row, the most that it missed in a row by itself; rows, pauses: of which that was made; limit(descriptor)."""

    def __init__(self, pid):
        self._vital = pages.Vital(pid)
        super().__init__()

    def _saw(self, rows, pauses):
        self.rows, self.pauses = rows, pauses
        self.in_a_row = in_a_row(rows, pauses, self._vital.period_s())

    def limit(self, descriptor):
        return limit_of(descriptor, self._vital.configuration(), self._vital.realtime())

    def _look(self, tells):
        with contextlib.suppress(PermissionError):      # then it may miss what others do; the limit is a longer one, too
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(pages.ABOVE_CYCLES))
            os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
        rows, pauses, before, now = [], [], self._vital.missed(), time.monotonic()
        tells.send(None)
        while not self._stop.is_set():
            time.sleep(PERIOD_S)
            last, now = now, time.monotonic()
            if now - last > 2 * PERIOD_S:
                pauses.append((last, now))
            if (missed := self._vital.missed()) != before:
                rows.append((now, missed - before))
                before = missed
        tells.send((rows, pauses))
