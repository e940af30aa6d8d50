# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The modes that random flights of this mission (simulation/campaign) begin and end in."""

MOSTLY = "quick"
DRIVEN = ["quick", "quick", "quick", "slow", "alone"]
ENDS = ["quick", "alone"]
