# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""How late the host was, watched by a process of its own: threads of a busy program wait for each other, which is no lateness of the host."""
import multiprocessing
import time

import punctual

LOOK_S = 0.02


class LateHost:
    """`with LateHost() as host:`; to begin before the program has threads."""

    def __init__(self):
        self._worst_s, self._over = multiprocessing.Value("d", 0.0), multiprocessing.Event()
        self._process = multiprocessing.Process(target=_watch, args=(self._worst_s, self._over), daemon=True)

    def __enter__(self):
        self._process.start()
        return self

    def __exit__(self, *_):
        self._over.set()
        self._process.join(5.0)

    def forget(self):
        self._worst_s.value = 0.0

    def worst_s(self):
        """Since it was to forget; 0 where nobody may see it."""
        time.sleep(3 * LOOK_S)
        return self._worst_s.value

    def was_late(self):
        """For longer than the shortest watchdog of a device waits."""
        return self.worst_s() > punctual.WATCHDOG_S


def _watch(worst_s, over):
    with punctual.Lateness() as host:
        while not over.wait(LOOK_S) and host.worst_s is not None:
            worst_s.value = max(worst_s.value, host.worst_s)
            host.worst_s = 0.0
