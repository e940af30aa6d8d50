# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The two pages between supervisor and subsystem (hirosco/subsystem/pages/pages.hpp), read from outside by a decoder of its own, and a
watch that looks at them once a millisecond, or as often as is asked for, from above all cycles. Python's standard library only."""
import dataclasses
import mmap
import multiprocessing
import os
import pathlib
import struct
import time

MAGIC, VERSION = 0x48495243, 8
# docs/interfaces/memory.md
LINKS_AT, LINK_OCTETS, LINKS, LIFE_AT, JUDGED_AT = 96, 24, 64, 2152, 4716
LATENCIES_AT, LATENCIES_OCTETS, COUNTS_IN_LATENCIES = 2156, 40, 4
STALE, ENDED = 2, 1 << 30
BY_DEVICE, WHILE_AWAITED = 4, 64           # of the inhibitions; the last one passes by itself
PERIOD_S = 0.001
ABOVE_CYCLES = 97             # the guard has 90, devices 85, cycles at most 80


def _words(number):
    return number & (1 << 64) - 1


def permission_word(epoch):
    """What lets actuators move under this epoch (adr 0019)."""
    word = _words(epoch + 0x9E3779B97F4A7C15)
    word = _words((word ^ word >> 30) * 0xBF58476D1CE4E5B9)
    word = _words((word ^ word >> 27) * 0x94D049BB133111EB)
    return word ^ word >> 31


class Page:
    """A page of a process, as the kernel shows it; it stays when the process has gone."""

    def __init__(self, pid, name):
        for place in pathlib.Path(f"/proc/{pid}/map_files").iterdir():
            if f"memfd:{name}" in os.readlink(place):
                with open(place, "rb") as file:
                    self._octets = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
                break
        else:
            raise AssertionError(f"process {pid} has no {name}")
        if struct.unpack_from("=II", self._octets) != (MAGIC, VERSION):
            raise AssertionError(f"{name} of process {pid} has another layout")

    def number(self, form, place):
        return struct.unpack_from(form, self._octets, place)[0]


class Permit(Page):
    def __init__(self, pid):
        super().__init__(pid, "hirosco-permit")

    def permits(self):
        return self.number("=Q", 16) == permission_word(self.number("=I", 8))


class Vital(Page):
    def __init__(self, pid):
        super().__init__(pid, "hirosco-vital")

    def period_s(self):
        return self.number("=Q", 32) / 1e9

    def cycles(self):
        return self.number("=Q", 40)

    def missed(self):
        return self.number("=Q", 64)

    def state(self):
        return self._checked(8)

    def configuration(self):
        return self._checked(12)

    def realtime(self):
        return self._checked(24)

    def inhibited(self):
        return self.number("=I", 16) & ~WHILE_AWAITED

    def inhibited_at_cycle(self):
        return self.number("=Q", 88)

    def has_ended(self):
        """By the word of the system, not of the process."""
        return self.number("=I", LIFE_AT) & ENDED != 0

    def links(self):
        """{place: id} of its incoming links."""
        found = {place: self.number("=I", LINKS_AT + LINK_OCTETS * place) for place in range(LINKS)}
        return {place: link for place, link in found.items() if link != 0}

    def samples(self, place):
        """Of a link, each in the cycle that had it first."""
        return sum(struct.unpack_from("=9I", self._octets, LATENCIES_AT + LATENCIES_OCTETS * place + COUNTS_IN_LATENCIES))

    def is_stale(self, place):
        return self.number("=I", JUDGED_AT + 4 * place) == STALE

    def _checked(self, place):
        word = self.number("=I", place)
        if word & 0xFFFF != ~word >> 16 & 0xFFFF:
            raise AssertionError(f"the word at {place} of a vital page is damaged: {word:#010x}")
        return word & 0xFFFF


def cycle_thread(pid):
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        if (task / "comm").read_text().strip() == "cycle":
            return int(task.name)
    raise AssertionError(f"process {pid} has no cycle thread")


@dataclasses.dataclass
class Look:
    """What a page says from this look on."""
    at: float
    cycles: int
    state: int
    inhibited: int                # bits
    inhibited_at_cycle: int


class Beside:
    """A block beside which another process looks: _look(tells) sends None when it does, and what it has seen once `_stop` is set; _saw() takes that."""

    def __init__(self):
        self._stop, (self._told, tells) = multiprocessing.Event(), multiprocessing.Pipe(False)
        self._process = multiprocessing.Process(target=self._look, args=(tells,), daemon=True)

    def __enter__(self):
        self._process.start()
        self._told.recv()           # it looks
        return self

    def __exit__(self, *_):
        self._stop.set()
        seen = self._told.recv()
        self._process.join()
        self._saw(*seen)


class Watch(Beside):
    """`with Watch(craft, programs) as watch:` — until the end of the block a process above all cycles looks at the pages of these
    programs. Afterwards, as time.monotonic(): fenced[program], when its permission ended; demoted[program], when its cycle
    thread lost its priority or was gone; ended[program], when the system marked the end of its process; counts[program], [(time, cycles)]
    wherever cycles had advanced; changes[program], [Look] wherever state or inhibition were others; gaps[program], {link: the most cycles in a row
    that had no new sample of it}, and stale[program], the links that were too old, of those that it had when the watch began; worst_s, how late the
    watch itself was; vital(program), its page."""

    def __init__(self, craft, programs, period_s=PERIOD_S):
        self._period_s = period_s
        pids = {program: craft.pid_of(program) for program in programs}
        self._pages = {program: (Permit(pid), Vital(pid), cycle_thread(pid)) for program, pid in pids.items()}
        super().__init__()

    def _saw(self, fenced, demoted, ended, counts, changes, gaps, stale, worst_s):
        self.fenced, self.demoted, self.ended, self.worst_s = fenced, demoted, ended, worst_s
        self.counts, self.changes, self.gaps, self.stale = counts, changes, gaps, stale

    def _look(self, tells):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(ABOVE_CYCLES))
        fenced, demoted, ended, worst_s = {}, {}, {}, 0.0
        counts, changes, stale = ({program: kind() for program in self._pages} for kind in (list, list, set))
        links = {program: vital.links() for program, (_, vital, _) in self._pages.items()}
        gaps = {program: dict.fromkeys(links[program].values(), 0) for program in self._pages}
        newest = {}                 # (program, place): how many samples there were, and up to which cycle
        permitted = {program for program, (permit, _, _) in self._pages.items() if permit.permits()}
        due = time.monotonic()
        tells.send(None)
        while not self._stop.is_set():
            due += self._period_s
            time.sleep(max(0.0, due - time.monotonic()))
            now = time.monotonic()
            worst_s = max(worst_s, now - due)
            due = max(due, now - self._period_s)
            for program, (permit, vital, thread) in self._pages.items():
                if program in permitted and program not in fenced and not permit.permits():
                    fenced[program] = now
                if program not in demoted and not self._has_priority(thread):
                    demoted[program] = now
                if program not in ended and vital.has_ended():
                    ended[program] = now
                look = Look(now, vital.cycles(), vital.state(), vital.inhibited(), vital.inhibited_at_cycle())
                seen, told = counts[program], changes[program]
                if not seen or seen[-1][1] != look.cycles:
                    seen.append((now, look.cycles))
                if not told or (told[-1].state, told[-1].inhibited) != (look.state, look.inhibited):
                    told.append(look)
                for place, link in links[program].items():
                    samples, before = vital.samples(place), newest.get((program, place))
                    if before is None or before[0] != samples:
                        newest[program, place] = samples, vital.cycles()
                    else:
                        gaps[program][link] = max(gaps[program][link], look.cycles - before[1])
                    if vital.is_stale(place):
                        stale[program].add(link)
        tells.send((fenced, demoted, ended, counts, changes, gaps, stale, worst_s))

    @staticmethod
    def _has_priority(thread):
        try:
            return os.sched_getscheduler(thread) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO
        except ProcessLookupError:
            return False

    def vital(self, program):
        return self._pages[program][1]

    def longest_pause_s(self, program, begin, end):
        """The longest time without a cycle that ends between these instants, or 0."""
        times = [at for at, _ in self.counts[program]]
        return max((after - before for before, after in zip(times, times[1:]) if begin <= after <= end), default=0.0)

    def cycles_before(self, program, instant):
        """How many cycles it had at the last look before this instant."""
        return max((cycles for at, cycles in self.counts[program] if at < instant), default=0)

    def first(self, program, wanted, since=0.0):
        """The first look from this instant on of which wanted(look) is true, or None. What is so already as it comes counts from then on."""
        before = [look for look in self.changes[program] if look.at < since][-1:]
        looks = [dataclasses.replace(look, at=since) for look in before] + [look for look in self.changes[program] if look.at >= since]
        return next((look for look in looks if wanted(look)), None)
