# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Makes a plan small: no single action of what is left can go without the violation going too."""
import concurrent.futures


def split(plan):
    head, actions = [], []
    for line in plan.splitlines():
        (actions if line[:1].isdigit() else head).append(line)
    return head, actions


def shrink(plan, fails, jobs=1):
    """`fails(plan)`: whether the violation is still there. Pieces are left out, halves first, single actions last."""
    head, actions = split(plan)
    join = lambda lines: "\n".join(head + lines) + "\n"
    size = max(len(actions) // 2, 1)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        while actions:
            at, shorter = 0, False
            while at < len(actions):
                # As many pieces beside one another as there are processors; the first that can go, goes.
                starts = range(at, min(at + size * jobs, len(actions)), size)
                tries = [actions[:start] + actions[start + size:] for start in starts]
                failing = list(pool.map(lambda lines: fails(join(lines)), tries))
                found = next((lines for lines, still in zip(tries, failing) if still), None)
                if found is None:
                    at += size * jobs
                else:
                    at += size * failing.index(True)
                    actions, shorter = found, True
            if size == 1 and not shorter:
                break
            size = max(size // 2, 1) if not shorter or size > 1 else 1
    return join(actions)
