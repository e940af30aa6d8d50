# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A failure code of the framework: its number and its words stand in one file. (An author's own is a row of the descriptor.)"""
WHO = "a failure code"
BEFORE = "0 + 5"
GOAL = "1 row; here its number and its words; its row in failure-codes.md"
MOST_FILES, MOST_EDITED = 0, 1
MOST_ASKED = 1
ASKED = [
    ("docs/failure-codes.md", "| 16 | power budget exceeded |", "| 0x7F | too dark | subsystem | none | Bring a light, then send again. |\n| 16 | power budget exceeded |",
     "pus_test FailureCodes.AreTheRowsInTheDocuments"),
]
MADE = [("docs/interfaces/packets.md", "tools/check_interfaces.py")]
HELD = ["interface_pages_test InterfacePages.CodesAndWords"]
FILES = {}
EDITS = [
    ("hirosco/pus/packet/failure_code.hpp", "      {PowerShort, \"power budget exceeded\"},\n",
     "      {PowerShort, \"power budget exceeded\"},\n      {TooDark, \"too dark\"},\n"),
    ("hirosco/pus/packet/failure_code.hpp", "enum class FailureCode : std::uint16_t {\n", "enum class FailureCode : std::uint16_t {\n  TooDark = 0x7F,\n"),
]
SOURCES = []
TRY = """\
#include <gtest/gtest.h>

#include "hirosco/pus/packet/failure_code.hpp"

TEST(NewCode, HasWords) { EXPECT_EQ(hirosco::to_text(hirosco::pus::FailureCode::TooDark), "too dark"); }
"""
