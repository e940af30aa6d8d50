# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The two pages between supervisor and subsystem (hirosco/subsystem/pages/pages.hpp), read from outside by a decoder of its own, and a
watch that looks at them once a millisecond from above all cycles. Python's standard library only."""
import mmap
import multiprocessing
import os
import pathlib
import struct
import time

MAGIC, VERSION = 0x48495243, 8
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


def cycle_thread(pid):
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        if (task / "comm").read_text().strip() == "cycle":
            return int(task.name)
    raise AssertionError(f"process {pid} has no cycle thread")


class Watch:
    """`with Watch(craft, programs) as watch:` — until the end of the block a process above all cycles looks at the pages of these
    programs. Afterwards, as time.monotonic(): fenced[program], when its permission ended; demoted[program], when its cycle
    thread lost its priority or was gone; counts[program], [(time, cycles)] wherever cycles had advanced; worst_s, how late the
    watch itself was."""

    def __init__(self, craft, programs):
        pids = {program: craft.pid_of(program) for program in programs}
        self._pages = {program: (Permit(pid), Vital(pid), cycle_thread(pid)) for program, pid in pids.items()}
        self._stop, (self._told, tells) = multiprocessing.Event(), multiprocessing.Pipe(False)
        self._process = multiprocessing.Process(target=self._look, args=(tells,), daemon=True)

    def __enter__(self):
        self._process.start()
        self._told.recv()           # it looks
        return self

    def __exit__(self, *_):
        self._stop.set()
        self.fenced, self.demoted, self.counts, self.worst_s = self._told.recv()
        self._process.join()

    def _look(self, tells):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(ABOVE_CYCLES))
        fenced, demoted, counts, worst_s = {}, {}, {program: [] for program in self._pages}, 0.0
        permitted = {program for program, (permit, _, _) in self._pages.items() if permit.permits()}
        due = time.monotonic()
        tells.send(None)
        while not self._stop.is_set():
            due += PERIOD_S
            time.sleep(max(0.0, due - time.monotonic()))
            now = time.monotonic()
            worst_s = max(worst_s, now - due)
            due = max(due, now - PERIOD_S)
            for program, (permit, vital, thread) in self._pages.items():
                if program in permitted and program not in fenced and not permit.permits():
                    fenced[program] = now
                if program not in demoted and not self._has_priority(thread):
                    demoted[program] = now
                cycles, seen = vital.cycles(), counts[program]
                if not seen or seen[-1][1] != cycles:
                    seen.append((now, cycles))
        tells.send((fenced, demoted, counts, worst_s))

    @staticmethod
    def _has_priority(thread):
        try:
            return os.sched_getscheduler(thread) & ~os.SCHED_RESET_ON_FORK == os.SCHED_FIFO
        except ProcessLookupError:
            return False

    def longest_pause_s(self, program, begin, end):
        """The longest time without a cycle that ends between these instants, or 0."""
        times = [at for at, _ in self.counts[program]]
        return max((after - before for before, after in zip(times, times[1:]) if begin <= after <= end), default=0.0)
