// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/testing.hpp"

/// A power budget that a subsystem measures (docs/adr/0124).
namespace hirosco::descriptor {
namespace {

using testing::changed;
using testing::data;
using testing::overlay;
using testing::rendered;

constexpr const char* array_text = R"(<Subsystem name="ARRAY" id="41">
  <StructRef name="STATE" id="0">
    <ParamRef name="LIT" id="0" type="BOOL"/><ParamRef name="BUDGET" id="1" type="DOUBLE" unit="W"/>
  </StructRef>
  <ParamRef name="ANGLE" id="2" type="DOUBLE" unit="deg"/>
  <ParamRef name="HIDDEN" id="3" type="DOUBLE" unit="W"/>
  <HKService id="4801" interval="100"><SampledOnce><ParamRef name="ANGLE"/><ParamRef name="STATE"/></SampledOnce></HKService>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
  <Configuration name="SLOW" id="2" sampling_us="2000"/>
</Subsystem>)";

/// The good mission with an array in it.
FileSource measured_by(const std::string& power, const std::string& array = array_text) {
  const std::string first = R"(<Subsystem executable="hirosco-flywheel" descriptor="flywheel.xml"/>)";
  const std::string text = changed(R"(<Power budget_W="150"/>)", "<Power " + power + "/>",
                                   changed(first, first + R"(<Subsystem executable="array" descriptor="array.xml"/>)"));
  return overlay({{"mission.xml", text}, {"array.xml", array}});
}
std::string first_words(const FileSource& source) {
  const auto reading = read_mission(data / "mission.xml", source);
  return reading.problems.empty() ? std::string{}
                                  : reading.problems.front().code + " " + reading.problems.front().message;
}
std::string problem_of(const std::string& power) { return first_words(measured_by(power)); }

TEST(MeasuredPower, HasItsPlaceInTheReportsOfWhoMeasures) {
  const auto source = measured_by(R"(budget_W="150" measured="ARRAY.STATE.BUDGET" age_ms="300" least_W="20.5")");
  const auto reading = read_mission(data / "mission.xml", source);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, source);
  ASSERT_TRUE(reading.value->power_measured);
  const MeasuredPower& measured = *reading.value->power_measured;
  EXPECT_EQ(measured.apid, 41);
  EXPECT_EQ(measured.at.structure, 4801);
  EXPECT_EQ(measured.at.offset, 9U) << "ANGLE has 8 octets, LIT one";
  EXPECT_EQ(measured.at.octets, 2U + 8 + 1 + 8);
  EXPECT_EQ(measured.age, std::chrono::milliseconds{300});
  EXPECT_EQ(reading.value->power_least_w, 20.5);
  EXPECT_EQ(reading.value->power_budget_w, 150);
}

TEST(MeasuredPower, ThatNobodyTellsIsRefusedWithTheReason) {
  const std::string good = R"(budget_W="150" measured="ARRAY.STATE.BUDGET" age_ms="200")";
  EXPECT_EQ(problem_of(good), "");
  EXPECT_EQ(
      problem_of(changed("200", "199", good)),
      "E0376 'ARRAY.STATE.BUDGET' measures no budget: no structure reports it in every configuration, alike and at "
      "least each 199 ms")
      << "SLOW reports each 200 ms";
  EXPECT_TRUE(problem_of(changed("STATE.BUDGET", "HIDDEN", good)).starts_with("E0376"));
  EXPECT_EQ(problem_of(changed("STATE.BUDGET", "ANGLE", good)),
            "E0376 'ARRAY.ANGLE' measures no budget: it is no single DOUBLE in W");
  EXPECT_EQ(problem_of(changed("STATE.BUDGET", "STATES", good)),
            "E0376 'ARRAY.STATES' measures no budget: it has no such parameter");
  EXPECT_TRUE(problem_of(changed("ARRAY.STATE", "ARRAYS.STATE", good)).starts_with("E0304"));
  EXPECT_TRUE(problem_of(changed("ARRAY.STATE.BUDGET", "ARRAY", good)).starts_with("E0110"));
  EXPECT_TRUE(problem_of(changed(" age_ms=\"200\"", "", good)).starts_with("E0105"));
  EXPECT_TRUE(problem_of(good + R"( least_W="150.1")").starts_with("E0376"));
  EXPECT_TRUE(problem_of(R"(budget_W="150" least_W="10")").starts_with("E0376"));
  EXPECT_TRUE(problem_of(R"(budget_W="150" age_ms="10")").starts_with("E0376"));
}

TEST(MeasuredPower, IsReportedAlikeInEveryConfigurationWithoutATelecommand) {
  const std::string good = R"(budget_W="150" measured="ARRAY.STATE.BUDGET" age_ms="500")";
  const auto with = [&](const std::string& array) { return first_words(measured_by(good, array)).substr(0, 5); };
  const std::string structure =
      R"(<HKService id="4801" interval="100"><SampledOnce><ParamRef name="ANGLE"/><ParamRef name="STATE"/></SampledOnce></HKService>)";
  const std::string other = changed(R"(<ParamRef name="ANGLE"/>)", "", structure);
  const auto apart = [&](const std::string& one, const std::string& slow) {
    return changed(R"(sampling_us="2000"/>)", R"(sampling_us="2000">)" + slow + "</Configuration>",
                   changed(R"(sampling_us="1000"/>)", R"(sampling_us="1000">)" + one + "</Configuration>",
                           changed(structure, "", array_text)));
  };
  EXPECT_EQ(with(apart(structure, structure)), "");
  EXPECT_EQ(with(apart(structure, "")), "E0376") << "not in the second";
  EXPECT_EQ(with(apart(structure, other)), "E0376") << "at another place";
  EXPECT_EQ(with(changed(R"(interval="100")", R"(interval="100" enabled="no")", array_text)), "E0376");
}

/// What members draw (docs/adr/0237).
FileSource drawn_by(const std::string& draw) {
  const std::string first = R"(<Subsystem executable="hirosco-flywheel" descriptor="flywheel.xml"/>)";
  const std::string text = changed(R"(<Power budget_W="150"/>)", R"(<Power budget_W="150">)" + draw + "</Power>",
                                   changed(first, first + R"(<Subsystem executable="array" descriptor="array.xml"/>)"));
  return overlay({{"mission.xml", text}, {"array.xml", array_text}});
}

TEST(PowerDraw, IsToldByAParameterOfAnybodyForOneOrSeveral) {
  const auto source = drawn_by(
      R"(<Draw of="FLYWHEEL ARRAY" measured="ARRAY.STATE.BUDGET" age_ms="300" beyond_W="2.5" longer_than_ms="4000"/>)"
      R"(<Draw of="FLYWHEEL" measured="ARRAY.STATE.BUDGET" age_ms="300" longer_than_ms="1"/>)");
  const auto reading = read_mission(data / "mission.xml", source);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, source);
  ASSERT_EQ(reading.value->power_draws.size(), 2U);
  const PowerDraw& both = reading.value->power_draws[0];
  EXPECT_EQ(both.of, (std::vector<std::uint16_t>{reading.value->find_subsystem("FLYWHEEL")->subsystem.id, 41}));
  EXPECT_EQ(both.measured.name, "ARRAY.STATE.BUDGET");
  EXPECT_EQ(both.measured.apid, 41);
  EXPECT_EQ(both.measured.at.offset, 9U);
  EXPECT_EQ(both.measured.age, std::chrono::milliseconds{300});
  EXPECT_EQ(both.beyond_w, 2.5);
  EXPECT_EQ(both.longer_than, std::chrono::seconds{4});
  EXPECT_EQ(reading.value->power_draws[1].beyond_w, 0);
  EXPECT_FALSE(reading.value->power_measured) << "that is another matter";
}

TEST(PowerDraw, ThatNobodyTellsOrOfNobodyIsRefused) {
  const auto told = [](const std::string& of, const std::string& measured, const std::string& times) {
    return first_words(drawn_by("<Draw of=\"" + of + "\" measured=\"" + measured + "\" " + times + "/>"));
  };
  const std::string load = "ARRAY.STATE.BUDGET", times = R"(age_ms="300" longer_than_ms="4000")";
  EXPECT_EQ(told("FLYWHEEL", load, times), "");
  EXPECT_EQ(told("FLYWHEL", load, times), "E0304 subsystem 'FLYWHEL' is not in the mission");
  EXPECT_EQ(told("FLYWHEEL FLYWHEEL", load, times).substr(0, 5), "E0113");
  EXPECT_EQ(told(" ", load, times).substr(0, 5), "E0109");
  EXPECT_EQ(told("FLYWHEEL", "ARRAY.ANGLE", times),
            "E0376 'ARRAY.ANGLE' measures no draw: it is no single DOUBLE in W");
  EXPECT_EQ(told("FLYWHEEL", load, R"(age_ms="10" longer_than_ms="4000")").substr(0, 5), "E0376");
  EXPECT_EQ(told("FLYWHEEL", load, R"(age_ms="300")").substr(0, 5), "E0105");
}

}  // namespace
}  // namespace hirosco::descriptor
