// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/icd/icd.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ground/clients/xtce/testing.hpp"

namespace hirosco::ground {
namespace {

using ::testing::HasSubstr;
using testing::mission_with;

std::string document_of(descriptor::Mission mission) { return interface_document(Catalogue{std::move(mission)}); }

TEST(InterfaceDocument, SaysThePlaceOfEveryValueOfAReport) {
  const std::string text = document_of(mission_with("ARM"));
  // Behind the header of 20 octets and the id of 2.
  EXPECT_THAT(text, HasSubstr("| 22 | `ARM` | 3 x UINT16 | ARM | 1 ARM, 2 two |"));
  EXPECT_THAT(text, HasSubstr("| 28 | `POSE.X` | DOUBLE | m | -2 to 1.5 |"));
  EXPECT_THAT(text, HasSubstr("| 36 | `POSE.ON` | BOOL |   |   |"));
  EXPECT_THAT(text, HasSubstr("| 61 | `POSE.X sample 4` | DOUBLE | m | -2 to 1.5 |"));
  EXPECT_THAT(text, HasSubstr("71 octets in all"));
}

TEST(InterfaceDocument, SaysRequestsEventsParametersAndFailures) {
  const std::string text = document_of(mission_with("ARM"));
  EXPECT_THAT(text, HasSubstr("#### ARM, TC[8,1]"));
  EXPECT_THAT(text, HasSubstr("| 1 | `X` | DOUBLE | m | -2 to 1.5 |"));
  EXPECT_THAT(text, HasSubstr("| 77 | `ARM` | low | ARM 3 x UINT16 ARM |"));
  EXPECT_THAT(text, HasSubstr("| 0xa0307 | `ARM` | 3 x UINT16 | ARM | 1 ARM, 2 two; may be set |"));
  EXPECT_THAT(text, HasSubstr("| 0x8001 | `ARM` |"));
  EXPECT_THAT(text, HasSubstr("| TM[17,129] | SELF_TEST_OUTCOME |"));
}

TEST(InterfaceDocument, NoNameBreaksATable) {
  for (const std::string& name : testing::hostile_names()) {
    const std::string text = document_of(mission_with(name));
    // As many lines as with a decent one.
    EXPECT_EQ(std::ranges::count(text, '\n'), std::ranges::count(document_of(mission_with("ARM")), '\n')) << name;
  }
}

}  // namespace
}  // namespace hirosco::ground
