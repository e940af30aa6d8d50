// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/permits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace hirosco::tools {
namespace {

descriptor::Mission permitting(std::vector<std::uint8_t> services) {
  descriptor::Mission mission;
  mission.file = "mission.xml";
  descriptor::Mode mode;
  mode.name = "day";
  mode.permits = {{.subsystem = "*", .functions = {}, .services = std::move(services), .parameters = {}, .at = {7, 3}}};
  mission.modes = {mode};
  return mission;
}

TEST(PermitProblems, ThereAreNoneOfTheServicesThatAModeOpens) {
  EXPECT_THAT(permit_problems(permitting({3, 5, 8, 17, 20})), ::testing::IsEmpty());
  EXPECT_THAT(permit_problems(permitting({192, 255})), ::testing::IsEmpty()) << "the reader has judged these";
}

TEST(PermitProblems, AServiceThatNobodyHasOrThatNoModeOpensIsToldWithThoseThatOneOpens) {
  for (const int service : {1, 2, 4, 21, 128, 129, 130, 191}) {
    const auto found = permit_problems(permitting({3, static_cast<std::uint8_t>(service)}));
    ASSERT_EQ(found.size(), 1U) << service;
    EXPECT_EQ(found.front().code, "E0352");
    EXPECT_EQ(found.front().file, "mission.xml");
    EXPECT_EQ(found.front().at, (descriptor::Location{7, 3}));
    EXPECT_EQ(found.front().grade, descriptor::Grade::Error);
    EXPECT_THAT(found.front().message, ::testing::HasSubstr("'day' permits service " + std::to_string(service)));
    EXPECT_THAT(found.front().hint, ::testing::HasSubstr("20 (parameters)"));
  }
}

}  // namespace
}  // namespace hirosco::tools
