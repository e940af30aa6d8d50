// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/framework_parameters.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {
using namespace testing;

Reading<SubsystemDescriptor> with(const std::string& body) {
  return read_text("<Subsystem name=\"ARM\" id=\"10\">\n" + body + "\n</Subsystem>");
}

std::string problems_of(const std::string& body) {
  std::string all;
  for (const auto& problem : with(body).problems) all += problem.code + " " + problem.message + "\n";
  return all;
}

TEST(FrameworkParameters, AreThereInADescriptorThatDeclaresNoneWithTheSameIdsInAll) {
  const auto subsystem = with("").value.value();
  const std::pair<const char*, std::uint8_t> wanted[]{{"CYCLE_STATS", 39},    {"CYCLE_TIMES", 40}, {"CYCLE_BUDGET", 38},
                                                      {"CYCLE_SPIN", 35},     {"LOOP_STATS", 34},  {"LINK_STATS", 41},
                                                      {"RESOURCE_STATS", 37}, {"HEAP_USES", 33},   {"DESCRIPTOR", 36}};
  ASSERT_EQ(subsystem.parameters.size(), std::size(wanted));
  for (const auto& [name, id] : wanted) {
    const Parameter* parameter = subsystem.find_parameter(name);
    ASSERT_NE(parameter, nullptr) << name;
    EXPECT_EQ(parameter->id, id);
    EXPECT_EQ(parameter->field.type, Type::Struct);
    EXPECT_FALSE(parameter->writable());
  }
  EXPECT_EQ(subsystem.find_parameter("CYCLE_STATS")->octets(), 12U);
  EXPECT_EQ(subsystem.find_parameter("CYCLE_TIMES")->octets(), 128U);
  EXPECT_EQ(subsystem.find_parameter("LINK_STATS")->octets(), 8U);
  EXPECT_EQ(subsystem.find_parameter("CYCLE_SPIN")->octets(), 16U);
  EXPECT_EQ(subsystem.find_parameter("LOOP_STATS")->octets(), 192U);
  EXPECT_EQ(subsystem.find_parameter("RESOURCE_STATS")->octets(), 150U);
  EXPECT_EQ(subsystem.find_parameter("HEAP_USES")->octets(), 17U);
  EXPECT_EQ(subsystem.find_parameter("DESCRIPTOR")->octets(), 6U);
}

TEST(FrameworkParameters, StandBehindTheAuthorsOwn) {
  const auto subsystem = with(R"(<ParamRef name="X" id="1" type="DOUBLE"/>)").value.value();
  EXPECT_EQ(subsystem.parameters.front().field.name, "X");
  EXPECT_EQ(subsystem.parameters.size(), 10U);
}

TEST(FrameworkParameters, AreReferredToLikeDeclaredOnes) {
  const auto reading = with(R"(<ParamRef name="X" id="1" type="UINT8" enumeration="STATES"/>
    <Configuration name="C" id="1" sampling_us="1000"><HKService id="1" interval="1">
      <SampledOnce><ParamRef name="CYCLE_STATS"/><ParamRef name="LINK_STATS.LOST"/></SampledOnce>
    </HKService></Configuration>)");
  ASSERT_TRUE(reading.value) << rendered(reading.problems, {});
  const auto& states = *std::ranges::find(reading.value->enumerations, "STATES", &Enumeration::name);
  ASSERT_EQ(states.texts.size(), 10U);
  EXPECT_EQ(states.texts[5].value, 5);
  EXPECT_EQ(states.texts[5].text, "Operational");
}

TEST(FrameworkParameters, DeclaredByHandAreToldOnceInWords) {
  for (const char* name : {"CYCLE_STATS", "CYCLE_TIMES", "CYCLE_BUDGET", "CYCLE_SPIN", "LINK_STATS", "LOOP_STATS",
                           "RESOURCE_STATS", "HEAP_USES", "DESCRIPTOR"}) {
    const std::string told = "E0213 '" + std::string{name} + "' is built in: every subsystem has it\n";
    EXPECT_EQ(problems_of("<StructRef name=\"" + std::string{name} +
                          R"(" id="40"><ParamRef name="LOST" id="243" type="UINT32"/></StructRef>)"),
              told);
    EXPECT_EQ(problems_of("<ParamRef name=\"" + std::string{name} + R"(" id="1" type="UINT32"/>)"), told);
  }
  EXPECT_EQ(problems_of(R"(<Enumeration name="STATES"><Text value="0">Offline</Text></Enumeration>)"),
            "E0213 'STATES' is built in: every subsystem has it\n");
  EXPECT_EQ(with("<ParamRef name=\"LINK_STATS\" id=\"1\" type=\"UINT32\"/>").problems.at(0).at.line, 2);
}

TEST(FrameworkParameters, HaveIdsThatNobodyElseHas) {
  EXPECT_EQ(problems_of(R"(<StructRef name="A" id="39"><ParamRef name="X" id="1" type="INT8"/></StructRef>)"),
            "E0203 type and id of 'A', STRUCT 39, are those of 'CYCLE_STATS', which every subsystem has\n");
  EXPECT_EQ(problems_of(R"(<StructRef name="A" id="1"><ParamRef name="X" id="243" type="UINT32"/></StructRef>)"),
            "E0203 type and id of 'X', UINT32 243, are those of 'LINK_STATS', which every subsystem has\n");
  EXPECT_EQ(problems_of(R"(<ParamRef name="A" id="241" type="FLOAT"/>)"),
            "E0203 type and id of 'A', FLOAT 241, are those of 'CYCLE_STATS', which every subsystem has\n");
  EXPECT_EQ(problems_of(R"(<ParamRef name="A" id="241" type="DOUBLE"/><ParamRef name="B" id="39" type="UINT32"/>)"),
            "");
}

TEST(FrameworkParameters, TakeAnotherIdFromTheDescriptorAndNothingElse) {
  const auto subsystem = with(R"(<StructRef name="CYCLE_STATS" id="7"/>)").value.value();
  EXPECT_EQ(subsystem.find_parameter("CYCLE_STATS")->id, 7);
  EXPECT_EQ(subsystem.find_parameter("CYCLE_STATS")->members.size(), 3U);
  EXPECT_EQ(subsystem.parameters.size(), 9U);
  EXPECT_EQ(problems_of(R"(<StructRef name="CYCLE_STATS" id="7"/>
    <StructRef name="A" id="7"><ParamRef name="X" id="1" type="INT8"/></StructRef>
    <StructRef name="B" id="39"><ParamRef name="X" id="2" type="INT8"/></StructRef>)"),
            "E0203 type and id of 'A', STRUCT 7, are those of 'CYCLE_STATS', which every subsystem has\n");
  EXPECT_EQ(problems_of(R"(<StructRef name="CYCLE_STATS"/>)"), "E0105 <StructRef> needs the attribute 'id'\n");
  EXPECT_EQ(problems_of(R"(<StructRef name="CYCLE_STATS" id="7" writable="Operational"/>)"),
            "E0103 <StructRef> has no attribute 'writable'\n");
}

TEST(FrameworkParameters, LeaveTheNamesOfTheirMembersToAuthors) {
  const auto reports = [](const char* name) {
    return R"(<StructRef name="A" id="1"><ParamRef name="LOST" id="1" type="INT8"/></StructRef>
      <HKService id="1" interval="1"><SampledOnce><ParamRef name=")" +
           std::string{name} + R"("/></SampledOnce></HKService>)";
  };
  EXPECT_EQ(problems_of(reports("LOST")), "");
  EXPECT_EQ(problems_of(reports("RECEIVED")), "E0204 HKService 1 refers to 'RECEIVED', which is not defined\n");
}

TEST(FrameworkParameters, AddedTwiceAreThereOnce) {
  auto subsystem = with("").value.value();
  add_framework_parameters(subsystem);
  EXPECT_EQ(subsystem.parameters.size(), 9U);
  EXPECT_EQ(std::ranges::count(subsystem.enumerations, "STATES", &Enumeration::name), 1);
}

// --- outputs of actuators ----------------------------------------------------------------------------------------------

const std::string two_actuators = R"(
    <Device name="LAMP"><Output><Field name="LIT" type="UINT8"/></Output></Device>
    <Device name="ARM" actuator="yes"><Output><Field name="TORQUE" type="DOUBLE" count="2" unit="N m" minimum="-5" maximum="5" safe="0 0"/>
      <Field name="BRAKE" type="UINT8" safe="1"/></Output></Device>
    <Device name="left-hand.1" actuator="yes"><Output><Field name="FORCE" type="DOUBLE" safe="0"/></Output></Device>)";

TEST(OutputParameters, AreTheOutputFieldsOfEachActuator) {
  const auto subsystem = with(two_actuators).value.value();
  EXPECT_EQ(subsystem.find_parameter("LAMP_OUTPUT"), nullptr) << "a lamp is no actuator";
  const Parameter* arm = subsystem.find_parameter("ARM_OUTPUT");
  ASSERT_NE(arm, nullptr);
  EXPECT_EQ(arm->id, 42);
  EXPECT_FALSE(arm->writable());
  ASSERT_EQ(arm->members.size(), 2U);
  EXPECT_EQ(arm->members[0].field.name, "TORQUE");
  EXPECT_EQ(arm->members[0].field.count, 2U);
  EXPECT_EQ(arm->members[0].field.unit, "N m");
  EXPECT_EQ(arm->members[0].field.maximum, Number{5});
  EXPECT_EQ(arm->members[0].id, 239);
  EXPECT_EQ(arm->members[1].id, 239) << "of another type";
  const Parameter* hand = subsystem.find_parameter("left_hand_1_OUTPUT");
  ASSERT_NE(hand, nullptr) << "what a device's name may have and a parameter's may not";
  EXPECT_EQ(hand->id, 43);
  EXPECT_EQ(hand->members[0].id, 238);
}

TEST(OutputParameters, AreReferredToWhereverTheirDeviceIsDeclared) {
  const std::string structure = R"(<HKService id="1" interval="1"><SampledOnce><ParamRef name="ARM_OUTPUT"/>
    <ParamRef name="left_hand_1_OUTPUT.FORCE"/></SampledOnce></HKService>)";
  EXPECT_EQ(problems_of(structure + two_actuators), "");
  EXPECT_EQ(problems_of(two_actuators + structure), "");
  EXPECT_EQ(
      problems_of(two_actuators +
                  R"(<HKService id="1" interval="1"><SampledOnce><ParamRef name="TORQUE"/></SampledOnce></HKService>)"),
      "E0204 HKService 1 refers to 'TORQUE', which is not defined\n")
      << "by the full name only";
}

TEST(OutputParameters, CollideWithAWordThatNamesThem) {
  EXPECT_EQ(
      problems_of(R"(<StructRef name="A" id="42"><ParamRef name="X" id="1" type="INT8"/></StructRef>)" + two_actuators),
      "E0203 type and id of 'A', STRUCT 42, are those of 'ARM_OUTPUT', which every subsystem with this actuator has\n");
  EXPECT_EQ(
      problems_of(R"(<ParamRef name="X" id="239" type="UINT8"/>)" + two_actuators),
      "E0203 type and id of 'X', UINT8 239, are those of 'ARM_OUTPUT', which every subsystem with this actuator has\n");
  EXPECT_EQ(problems_of(R"(<ParamRef name="ARM_OUTPUT" id="1" type="UINT8"/>)" + two_actuators),
            "E0213 'ARM_OUTPUT' is built in: every subsystem has it\n");
  EXPECT_EQ(problems_of(R"(<StructRef name="CYCLE_STATS" id="42"/>)" + two_actuators),
            "E0203 type and id of 'CYCLE_STATS', STRUCT 42, are those of 'ARM_OUTPUT', which every subsystem with this "
            "actuator has\n");
  EXPECT_EQ(problems_of(R"(<StructRef name="ARM_OUTPUT" id="7"/>
    <StructRef name="A" id="42"><ParamRef name="X" id="1" type="INT8"/></StructRef>)" +
                        two_actuators),
            "");
}

TEST(OutputParameters, HaveIdsForTwoHundredFieldsOfAType) {
  const auto actuators = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
      text += "<Device name=\"D" + std::to_string(i) +
              R"(" actuator="yes"><Output><Field name="F" type="INT8" safe="0"/></Output></Device>)";
    return text;
  };
  EXPECT_EQ(problems_of(actuators(200)), "");
  EXPECT_EQ(problems_of(actuators(201)), "E0232 no ids are left for the outputs of 'D200'\n");
}

}  // namespace
}  // namespace hirosco::descriptor
