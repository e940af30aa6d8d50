// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/testing.hpp"

/// Between which configurations a subsystem goes while it acts, and what the reader has against it.
namespace hirosco::descriptor {
namespace {

using namespace testing;

const std::string arm_text = R"(<Subsystem name="ARM" id="10">
  <ParamRef name="KP" id="0" type="DOUBLE" init="1"/>
  <Device name="JOINT" actuator="yes">
    <Output><Field name="TORQUE" type="DOUBLE" safe="0"/><Field name="BRAKE" type="UINT8" safe="0"/></Output>
    <Enable transfer="shared_memory" address="enable"/>
  </Device>
  <Configuration name="SOFT" id="1" sampling_us="1000" SOFT><Set parameter="KP" value="2"/>DEVICE SETS</Configuration>
  <Configuration name="STIFF" id="2" sampling_us="1000"><Set parameter="KP" value="9"/>
    <Device name="JOINT"><Endnode transfer="shared_memory" address="joint"/></Device>
    <RealTimeLinkService><Provides name="STATE"><ParamRef name="KP"/></Provides></RealTimeLinkService>
  </Configuration>
  <Configuration name="PARKED" id="3" sampling_us="1000"/>
  BUMPLESS
</Subsystem>)";

const std::string used_device = R"(<Device name="JOINT"><Endnode transfer="shared_memory" address="joint"/></Device>)";
const std::string state_set =
    R"(<RealTimeLinkService><Provides name="STATE"><ParamRef name="KP"/></Provides></RealTimeLinkService>)";
const std::string step_bounds =
    R"(<Step device="JOINT" output="TORQUE" most="0.5"/><Step device="JOINT" output="BRAKE" most="0"/>)";
const std::string good_bumpless = R"(<Bumpless between="SOFT STIFF">)" + step_bounds + "</Bumpless>";

std::string arm_with(const std::string& bumpless, const std::string& soft = "", const std::string& used = used_device,
                     const std::string& linked = state_set) {
  std::string text = arm_text;
  for (const auto& [from, to] : {std::pair<std::string, std::string>{" SOFT>", " " + soft + ">"},
                                 {"DEVICE", used},
                                 {"SETS", linked},
                                 {"BUMPLESS", bumpless}})
    text.replace(text.find(from), from.size(), to);
  return text;
}

std::string bumpless_problem_of(const std::string& text) {
  const auto reading = read_text(text);
  if (reading.problems.size() != 1U) return rendered(reading.problems, text_source(text)) + " (not one)";
  return reading.problems[0].code + " " + reading.problems[0].message;
}

TEST(Bumpless, HoldsBothWaysBetweenTheNamedConfigurationsAndBoundsEachOutput) {
  const SubsystemDescriptor read = read_text(arm_with(good_bumpless)).value.value();
  const Bumpless* between = read.bumpless_between(1, 2);
  ASSERT_NE(between, nullptr);
  EXPECT_EQ(between, read.bumpless_between(2, 1));
  EXPECT_EQ(read.bumpless_between(1, 3), nullptr);
  EXPECT_EQ(read.bumpless_between(1, 1), nullptr) << "one that is in force follows nothing";
  ASSERT_EQ(between->steps.size(), 2U);
  EXPECT_EQ(between->steps[0].device, 0U);
  EXPECT_EQ(between->steps[0].output, 0U);
  EXPECT_EQ(between->steps[0].most, 0.5);
  EXPECT_EQ(between->steps[1].output, 1U);
}

TEST(Bumpless, SaysWhatIsAgainstIt) {
  const auto against = [](const std::string& words) { return "E0246 'SOFT' and 'STIFF' are not compatible: " + words; };
  EXPECT_EQ(
      bumpless_problem_of(arm_with(
          good_bumpless, "", R"(<Device name="JOINT"><Endnode transfer="shared_memory" address="other"/></Device>)")),
      against("they do not use the same devices in the same way: endnodes, fall-backs, settings, limits, order"));
  EXPECT_EQ(bumpless_problem_of(arm_with(
                good_bumpless, "",
                R"(<Device name="JOINT" silence="7"><Endnode transfer="shared_memory" address="joint"/></Device>)")),
            against("they do not use the same devices in the same way: endnodes, fall-backs, settings, limits, order"));
  EXPECT_EQ(bumpless_problem_of(arm_with(good_bumpless, "", used_device, "")),
            against("they do not provide the same sets, in the same order and by the same terms"));
  EXPECT_EQ(bumpless_problem_of(arm_with(good_bumpless, "", used_device,
                                         R"(<RealTimeLinkService><Provides name="STATE"><ParamRef name="KP"/></Provides>
                               <Requires name="HAND"><Field name="X" type="DOUBLE"/></Requires></RealTimeLinkService>)")),
            against("they do not require the same sets, in the same order and by the same terms"));
  EXPECT_EQ(bumpless_problem_of(arm_with(good_bumpless, R"(self_test="required")")),
            against("a required self test is passed before Operational, in Safe-Operational"));
  const std::string slower = arm_with(good_bumpless);
  EXPECT_EQ(bumpless_problem_of(changed(R"(id="2" sampling_us="1000")", R"(id="2" sampling_us="2000")", slower)),
            against("the consumers of 'STATE' have agreed on its period, 1000 and 2000 us"));
}

TEST(Bumpless, GoesToAnotherPeriodWhereNobodyHasAgreedOnIt) {
  std::string text = arm_with(good_bumpless, "", used_device, "");
  text = changed(state_set, "", text);
  EXPECT_TRUE(read_text(changed(R"(id="2" sampling_us="1000")", R"(id="2" sampling_us="2000")", text)).value);
}

TEST(Bumpless, RefusesWhatItCannotMean) {
  EXPECT_EQ(bumpless_problem_of(arm_with(R"(<Bumpless between="SOFT">)" + step_bounds + "</Bumpless>")),
            "E0246 one configuration alone goes nowhere");
  EXPECT_EQ(bumpless_problem_of(arm_with(R"(<Bumpless between="SOFT STIFF HARD">)" + step_bounds + "</Bumpless>")),
            "E0246 the subsystem has no configuration 'HARD'");
  EXPECT_EQ(bumpless_problem_of(arm_with(R"(<Bumpless between="SOFT STIFF STIFF">)" + step_bounds + "</Bumpless>")),
            "E0246 'STIFF' stands in a <Bumpless> twice");
  EXPECT_EQ(bumpless_problem_of(arm_with(
                R"(<Bumpless between="SOFT STIFF"><Step device="JOINT" output="TORQUE" most="1"/></Bumpless>)")),
            "E0247 nothing bounds 'BRAKE' of actuator 'JOINT' where the configuration changes");
  EXPECT_EQ(bumpless_problem_of(arm_with(changed("TORQUE", "TORQUES", good_bumpless))).substr(0, 5), "E0247");
  EXPECT_EQ(bumpless_problem_of(arm_with(changed("0.5", "-1", good_bumpless))), "E0112 most -1 is out of range");
}

}  // namespace
}  // namespace hirosco::descriptor
