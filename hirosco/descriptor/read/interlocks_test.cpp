// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/descriptor/testing.hpp"

/// What has to hold before a mode is entered (docs/adr/0075), as it is read.
namespace hirosco::descriptor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The mission of the examples, with this in front of what its mode telepresence commissions, and with these attributes.
Reading<Mission> read_with(const std::string& inside, const std::string& attributes = {},
                           const std::string& mode = R"(<Mode name="telepresence" id="7")") {
  std::string text = testing::good_mission();
  const auto at = text.find(mode) + mode.size();
  text.insert(text.find('>', at) + 1, inside);
  text.insert(at, " " + attributes);
  return read_mission(testing::data / "mission.xml", testing::overlay({{"mission.xml", text}}));
}

[[nodiscard]] std::vector<std::string> codes_of(const Reading<Mission>& reading) {
  std::vector<std::string> codes;
  for (const Diagnostic& problem : reading.problems) codes.push_back(problem.code);
  return codes;
}

TEST(Interlocks, AreReadWithTheirStatesAndConfiguration) {
  const auto reading =
      read_with(R"(<Needs subsystem="FLYWHEEL" state="Offline"/>)"
                R"(<Excludes subsystem="CORONAGRAPH" state="SafeOperational Operational" configuration="COUPLED"/>)",
                R"(from="commissioning")");
  ASSERT_TRUE(reading.value) << testing::rendered(reading.problems, file_system());
  const Mode& mode = *reading.value->find_mode("telepresence");
  EXPECT_THAT(mode.from, ElementsAre("commissioning"));
  ASSERT_EQ(mode.interlocks.size(), 2U);
  EXPECT_EQ(mode.interlocks[0].kind, Interlock::Kind::Needs);
  EXPECT_EQ(to_string(mode.interlocks[0]), "FLYWHEEL in Offline");
  EXPECT_EQ(mode.interlocks[1].kind, Interlock::Kind::Excludes);
  EXPECT_EQ(to_string(mode.interlocks[1]), "CORONAGRAPH in SafeOperational or Operational with COUPLED");
}

TEST(Interlocks, ThatNameNobodyOrNothingAreReported) {
  EXPECT_THAT(codes_of(read_with("", R"(from="commisioning")")), ::testing::Contains("E0305"));
  EXPECT_THAT(codes_of(read_with(R"(<Needs subsystem="FLYWHEEL" state="SoftwareInit"/>)")),
              ::testing::Contains("E0306"));
  EXPECT_THAT(codes_of(read_with(R"(<Needs subsystem="FLYWHEEL" state="Oflline"/>)")), ::testing::Not(IsEmpty()));
  EXPECT_THAT(codes_of(read_with(R"(<Excludes subsystem="NOBODY" state="Operational"/>)")), ::testing::Not(IsEmpty()));
  EXPECT_THAT(codes_of(read_with(R"(<Excludes subsystem="FLYWHEEL" state="Operational" configuration="NONE"/>)")),
              ::testing::Contains("E0316"));
  EXPECT_THAT(codes_of(read_with(R"(<Needs subsystem="FLYWHEEL"/>)")), ::testing::Contains("E0105"));
}

TEST(Interlocks, OfTheStartModeMustHoldWithEverybodyOffline) {
  EXPECT_THAT(codes_of(read_with(R"(<Needs subsystem="FLYWHEEL" state="Operational"/>)")), ElementsAre("E0330"));
  EXPECT_THAT(codes_of(read_with(R"(<Excludes subsystem="FLYWHEEL" state="Offline"/>)")), ElementsAre("E0330"));
  EXPECT_THAT(codes_of(read_with("", R"(from="telepresence")")), ElementsAre("E0330"));
  EXPECT_THAT(codes_of(read_with(R"(<Excludes subsystem="FLYWHEEL" state="Operational"/>)")), IsEmpty());
}

TEST(Interlocks, OfTheInitialModeMustHoldWithEverybodyOffline) {
  const auto initial = [](const std::string& inside, const std::string& attributes = {}) {
    return codes_of(read_with(inside, attributes, R"(<Mode name="commissioning")"));
  };
  EXPECT_THAT(initial(R"(<Needs subsystem="FLYWHEEL" state="Operational"/>)"), ElementsAre("E0356"));
  EXPECT_THAT(initial(R"(<Excludes subsystem="FLYWHEEL" state="Offline Operational"/>)"), ElementsAre("E0356"));
  EXPECT_THAT(initial(R"(<Excludes subsystem="FLYWHEEL" state="Operational"/>)"), IsEmpty());
  EXPECT_THAT(initial("", R"(from="telepresence")"), IsEmpty()) << "a flight comes from no mode";
}

TEST(Interlocks, AFlightStartsInAModeThatCanBeTheFirstAndInNoOther) {
  Mission mission = *read_with("").value;
  EXPECT_FALSE(start_in(mission, "commissioning"));
  EXPECT_EQ(mission.start_mode, "commissioning");
  EXPECT_THAT(start_in(mission, "telepresense").value_or(""),
              HasSubstr("no mode 'telepresense': commissioning, telepresence"));
  mission.modes[1].from = {"telepresence"};
  EXPECT_THAT(start_in(mission, "telepresence").value_or(""),
              HasSubstr("mode 'telepresence' cannot be the first: it is not entered from 'commissioning'"));
  EXPECT_EQ(mission.start_mode, "commissioning") << "what is refused changes nothing";
}

}  // namespace
}  // namespace hirosco::descriptor
