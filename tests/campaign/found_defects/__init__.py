# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""What defects_in_unit_tests.py puts back into a copy of the code: findings of review, each with the test that sees it."""
from . import subsystem, supervisor, surroundings

DEFECTS = [*supervisor.DEFECTS, *subsystem.DEFECTS, *surroundings.DEFECTS]
