# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""Cases of the judge's rules: @case(rule, found=words of the violation, or none) on a function that writes the flight."""
import collections

from judge_flight import MISSION

Case = collections.namedtuple("Case", "rule build found mission")
CASES = []


def case(rule, found="", mission=MISSION):
    def take(build):
        CASES.append(Case(rule, build, found, mission))
        return build
    return take
