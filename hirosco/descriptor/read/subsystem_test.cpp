// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "hirosco/descriptor/model/framework_parameters.hpp"
#include "hirosco/descriptor/testing.hpp"
#include "hirosco/utilities/testing/slice.hpp"

namespace hirosco::descriptor {
namespace {

using testing::data;
using testing::read_text;
using testing::rendered;
using testing::text_source;

constexpr const char* listing_1 = R"(<StructRef name="CUR_VALUES" id="0" type="STRUCT">
  <ParamRef name="STATE" id="0" type="INT32" />
  <ParamRef name="POSITION" id="0" type="DOUBLE" />
</StructRef>

<ParamRef name="DES_POSITION" id="1" type="DOUBLE" />
)";
constexpr const char* listing_2 = R"(<HKService id="4711" interval="500">
  <SampledOnce>
    <ParamRef name="CUR_VALUES" />
  </SampledOnce>
  <SampledNREPTimes nrep="5">
    <ParamRef name="DES_POSITION" />
  </SampledNREPTimes>
</HKService>
)";

void expect_paper_model(const std::string& text, bool in_configuration) {
  const auto reading = read_text(text);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, text_source(text));
  const SubsystemDescriptor& subsystem = *reading.value;
  ASSERT_EQ(subsystem.parameters.size(), 2U + framework_parameters().size());
  const Parameter& values = subsystem.parameters[0];
  EXPECT_EQ(values.field.name, "CUR_VALUES");
  EXPECT_EQ(values.field.type, Type::Struct);
  ASSERT_EQ(values.members.size(), 2U);
  EXPECT_EQ(values.members[1].field.type, Type::Double);
  EXPECT_EQ(values.octets(), 12U);
  const auto& structures = in_configuration ? subsystem.configurations.at(0).housekeeping : subsystem.housekeeping;
  ASSERT_EQ(structures.size(), 1U);
  EXPECT_EQ(structures[0].id, 4711);
  EXPECT_EQ(structures[0].interval_cycles, 500U);
  EXPECT_TRUE(structures[0].enabled);
  ASSERT_EQ(structures[0].sampled_once.size(), 1U);
  EXPECT_EQ(fields_of(subsystem, structures[0].sampled_once[0]).size(), 2U);
  ASSERT_EQ(structures[0].sampled_repeatedly.size(), 1U);
  EXPECT_EQ(structures[0].sampled_repeatedly[0].repetitions, 5);
  EXPECT_EQ(structures[0].sampled_repeatedly[0].parameters.at(0).parameter, 1);
}

TEST(SubsystemDescriptor, AcceptsTheListingsOfThePaperDirectlyInsideIt) {
  expect_paper_model(std::string{"<Subsystem name=\"S\" id=\"10\">\n"} + listing_1 + listing_2 + "</Subsystem>", false);
}

TEST(SubsystemDescriptor, AcceptsTheListingsOfThePaperInParametersAndConfiguration) {
  expect_paper_model(std::string{"<Subsystem name=\"S\" id=\"10\"><Parameters>\n"} + listing_1 +
                         "</Parameters><Configuration name=\"C\" id=\"1\" sampling_us=\"500\">" + listing_2 +
                         "</Configuration></Subsystem>",
                     true);
}

TEST(SubsystemDescriptor, FillsTheWholeModel) {
  const auto reading = read_subsystem(data / "coronagraph.xml", file_system());
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const SubsystemDescriptor& robot = *reading.value;
  EXPECT_EQ(robot.name, "CORONAGRAPH");
  EXPECT_EQ(robot.id, 10);
  EXPECT_EQ(robot.description, "Two-joint robot, torque controlled, flexible joints");
  EXPECT_EQ(robot.file, data / "coronagraph.xml");
  EXPECT_EQ(robot.enumerations.at(0).texts.at(1).text, "Operational");
  EXPECT_EQ(robot.parameters.at(0).octets(), 4U + 16 + 16 + 8);
  const Parameter* goal = robot.find_parameter("DES_POSITION");
  ASSERT_NE(goal, nullptr);
  EXPECT_EQ(goal->init, (std::vector<Value>{-0.80, 1.60}));
  EXPECT_EQ(goal->field.minimum, -2.0);
  EXPECT_EQ(goal->field.unit, "rad");
  EXPECT_EQ(robot.find_parameter("NONE"), nullptr);
  EXPECT_EQ(robot.find_event("TORQUE_LIMIT_EXCEEDED")->severity, Severity::Medium);
  EXPECT_EQ(robot.find_event("TORQUE_LIMIT_EXCEEDED")->arguments.at(1).unit, "N m");
  EXPECT_EQ(robot.hang.reduced, 200U);
}

TEST(SubsystemDescriptor, FillsFunctionsOfAllScopes) {
  const SubsystemDescriptor robot = read_subsystem(data / "coronagraph.xml", file_system()).value.value();
  ASSERT_EQ(robot.functions.size(), 4U);
  const Function* move = robot.find_function("MOVE_TO");
  EXPECT_TRUE(move->permitted_in(State::Operational));
  EXPECT_FALSE(move->permitted_in(State::SafeOperational));
  EXPECT_EQ(move->arguments.at(1).fallback, Value{5.0});
  EXPECT_EQ(move->arguments.at(0).fallback, std::nullopt);
  EXPECT_EQ(move->description, "Moves on a straight line in joint space");
  EXPECT_TRUE(robot.find_function("HOLD")->permitted_in(State::SafeOperational));
  EXPECT_TRUE(robot.find_function("HOLD")->essential);
  EXPECT_FALSE(robot.find_function("HOLD")->confirm);
  EXPECT_TRUE(robot.find_function("RELEASE")->confirm);
  const auto only = read_subsystem(data / "hello.xml", file_system());
  ASSERT_TRUE(only.value) << rendered(only.problems, file_system());
  EXPECT_NE(only.value->find_function("MOVE_TO"), nullptr) << "it stands in the only configuration";
}

TEST(SubsystemDescriptor, AParameterIsWritableInTheStatesItNamesOnly) {
  const SubsystemDescriptor robot = read_subsystem(data / "coronagraph.xml", file_system()).value.value();
  const Parameter& goal = *robot.find_parameter("DES_POSITION");
  EXPECT_EQ(goal.writable_states, 1U << 3 | 1U << 4);
  EXPECT_TRUE(goal.writable_in(State::SafeOperational));
  EXPECT_FALSE(goal.writable_in(State::Operational));
  EXPECT_FALSE(goal.protection);
  EXPECT_FALSE(robot.find_parameter("CUR_VALUES")->writable()) << "never, unless it says so";
  EXPECT_TRUE(robot.find_parameter("TORQUE_LIMIT")->protection);
}

TEST(SubsystemDescriptor, AFunctionLeavesBehindWhatItSaysThatItSetsAndTheProtectionsThatItsArgumentsAreOf) {
  const std::string text = R"(<Subsystem name="S" id="10">
    <ParamRef name="PLAIN" id="1" type="DOUBLE" minimum="0" maximum="1"/>
    <ParamRef name="LIMIT" id="2" type="DOUBLE" minimum="0" maximum="1" protection="yes"/>
    <ParamRef name="LIMITS" id="3" type="FLOAT" count="3" protection="yes"/>
    <StructRef name="LOAD" id="1"><ParamRef name="MASS" id="4" type="DOUBLE"/><ParamRef name="PLACE" id="5" type="DOUBLE"/></StructRef>
    <ParamRef name="FIXED" id="6" type="DOUBLE" init="2" minimum="2" maximum="2" protection="yes"/>
    <ParamRef name="BY_MODE" id="7" type="DOUBLE" minimum="0" maximum="2" protection="yes"/>
    <FunctionService>
      <Function name="MOVE"><Argument name="V" of="PLAIN"/></Function>
      <Function name="SET" sets="LOAD.PLACE LOAD.MASS"><Argument name="V" of="LIMIT"/></Function>
    </FunctionService>
    <CustomService name="C" type="200"><Request name="ALL" subtype="1" sets="LIMITS"/></CustomService>
    <Configuration name="A" id="1" sampling_us="1000"><Set parameter="BY_MODE" value="1"/></Configuration>
  </Subsystem>)";
  const auto reading = read_text(text);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, text_source(text));
  const auto names = [&](const Function& function) {
    std::string all;
    for (const std::uint16_t parameter : function.unrepeated)
      all += reading.value->parameters[parameter].field.name + " ";
    return all;
  };
  EXPECT_EQ(names(*reading.value->find_function("MOVE")), "");
  EXPECT_EQ(names(*reading.value->find_function("SET")), "LIMIT LOAD ");
  EXPECT_EQ(names(*reading.value->find_request(200, 1)), "LIMITS ");
}

TEST(SubsystemDescriptor, AnArgumentOfAParameterHasItsRange) {
  const SubsystemDescriptor robot = read_subsystem(data / "coronagraph.xml", file_system()).value.value();
  const Function::Argument& limit = robot.find_function("SET_TORQUE_LIMIT")->arguments.at(0);
  EXPECT_EQ(limit.of, "TORQUE_LIMIT");
  EXPECT_EQ(limit.field.name, "LIMIT");
  EXPECT_EQ(limit.field.unit, "N m");
  EXPECT_EQ(limit.field.minimum, 0);
  EXPECT_EQ(limit.field.maximum, 15);
  EXPECT_EQ(limit.fallback, Value{12});
  const auto reading = read_text(
      "<Subsystem name=\"S\" id=\"10\"><FunctionService><Function name=\"SET\"><Argument name=\"COLD\" "
      "of=\"LIMITS\"/></Function></FunctionService><ParamRef name=\"LIMITS\" id=\"1\" type=\"FLOAT\" count=\"3\" "
      "minimum=\"0\" maximum=\"90\"/></Subsystem>");
  ASSERT_TRUE(reading.value) << rendered(reading.problems, text_source(""));
  const Field& cold = reading.value->functions.at(0).arguments.at(0).field;
  EXPECT_EQ(cold.count, 1) << "one value of the array";
  EXPECT_EQ(cold.type, Type::Float);
  EXPECT_EQ(cold.maximum, 90);
}

TEST(SubsystemDescriptor, ArgumentsOfFunctionsHaveEveryTypeAndExactRanges) {
  const std::string text = R"(<Subsystem name="S" id="10">
    <Enumeration name="COLOURS"><Text value="-1">red</Text><Text value="7">green</Text></Enumeration>
    <FunctionService><Function name="PROGRAM">
      <Argument name="SERIAL" type="UINT64" minimum="1" maximum="18446744073709551615"/>
      <Argument name="OFFSET" type="INT64" minimum="-9223372036854775808" maximum="9007199254740993"
                default="9007199254740993"/>
      <Argument name="COLOUR" type="INT8" enumeration="COLOURS" default="7"/>
      <Argument name="NOTE" type="TEXT" octets="200" default="so"/>
      <Argument name="ON" type="BOOL" count="3"/>
    </Function></FunctionService></Subsystem>)";
  const auto reading = read_text(text);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, text_source(text));
  const auto& arguments = reading.value->find_function("PROGRAM")->arguments;
  ASSERT_EQ(arguments.size(), 5U);
  EXPECT_EQ(arguments[0].field.maximum, Number{UINT64_MAX});
  EXPECT_EQ(arguments[1].field.minimum, Number{INT64_MIN});
  EXPECT_EQ(arguments[1].fallback, Value{std::int64_t{9007199254740993}});
  ASSERT_EQ(arguments[2].texts.size(), 2U);
  EXPECT_EQ(arguments[2].texts[1].text, "green");
  EXPECT_EQ(arguments[3].fallback, Value{"so"});
  EXPECT_EQ(arguments[3].octets(), 202U);
  EXPECT_EQ(arguments[4].field.type, Type::Bool);
  EXPECT_EQ(arguments[4].field.count, 3);
  ASSERT_EQ(arguments[4].texts.size(), 2U);
}

TEST(SubsystemDescriptor, ParametersAreSwitchesAndWordsAndNamesOfValues) {
  const std::string text = R"(<Subsystem name="S" id="10">
    <ParamRef name="ON" id="1" type="BOOL" init="true" writable="Operational"/>
    <ParamRef name="SHUTTERS" id="2" type="BOOL" count="3" init="off 1 TRUE"/>
    <ParamRef name="TITLE" id="3" type="TEXT" octets="12" init="night watch" writable="Operational"/>
    <ParamRef name="COLOUR" id="4" type="UINT8" enumeration="COLOURS" init="Pale Green"/>
    <ParamRef name="PAIR" id="5" type="INT8" count="2" enumeration="COLOURS" init="red 7"/>
    <ParamRef name="SERIAL" id="6" type="UINT64" init="18446744073709551615"/>
    <StructRef name="LAMP" id="7" writable="Operational">
      <ParamRef name="LIT" id="8" type="BOOL"/><ParamRef name="OWNER" id="9" type="TEXT" octets="5"/>
    </StructRef>
    <Enumeration name="COLOURS"><Text value="1">red</Text><Text value="7">pale green</Text></Enumeration>
    <FunctionService><Function name="LIGHT"><Argument name="LIT" of="LAMP.LIT" default="on"/>
      <Argument name="OWNER" of="OWNER" default="me"/></Function></FunctionService>
    <Configuration name="C" id="1" sampling_us="100">
      <HKService id="1" interval="1"><SampledOnce><ParamRef name="LAMP"/><ParamRef name="TITLE"/></SampledOnce></HKService>
      <Set parameter="COLOUR" value="red"/><Set parameter="LAMP.OWNER" value="nobod"/><Set parameter="LIT" value="1"/>
      <Set parameter="TITLE" value=""/>
    </Configuration></Subsystem>)";
  const auto reading = read_text(text);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, text_source(text));
  const SubsystemDescriptor& subsystem = *reading.value;
  const auto init = [&](std::string_view name) { return subsystem.find_parameter(name)->init; };
  EXPECT_EQ(init("ON"), (std::vector<Value>{1}));
  EXPECT_EQ(init("SHUTTERS"), (std::vector<Value>{0, 1, 1}));
  EXPECT_EQ(init("TITLE"), (std::vector<Value>{"night watch"}));
  EXPECT_EQ(init("COLOUR"), (std::vector<Value>{7}));
  EXPECT_EQ(init("PAIR"), (std::vector<Value>{1, 7}));
  EXPECT_EQ(init("SERIAL"), (std::vector<Value>{UINT64_MAX}));
  EXPECT_EQ(subsystem.find_parameter("TITLE")->octets(), 12U) << "without a length in front";
  EXPECT_EQ(subsystem.find_parameter("LAMP")->octets(), 6U);
  const auto& arguments = subsystem.find_function("LIGHT")->arguments;
  EXPECT_EQ(arguments.at(0).fallback, Value{1});
  EXPECT_EQ(arguments.at(0).texts.size(), 2U);
  EXPECT_EQ(arguments.at(1).field.text_octets, 5U);
  EXPECT_EQ(arguments.at(1).fallback, Value{"me"});
  const auto& initial = subsystem.configurations.at(0).initial;
  ASSERT_EQ(initial.size(), 4U);
  EXPECT_EQ(initial[0].values, (std::vector<Value>{1}));
  EXPECT_EQ(initial[1].values, (std::vector<Value>{"nobod"}));
  EXPECT_EQ(initial[2].parameter.member, 0);
  EXPECT_EQ(initial[3].values, (std::vector<Value>{""}));
}

TEST(SubsystemDescriptor, AnActuatorDeclaresItsStopAndItsSecondInhibit) {
  const SubsystemDescriptor robot = read_subsystem(data / "coronagraph.xml", file_system()).value.value();
  const Device& device = robot.devices.at(0);
  EXPECT_EQ(device.stop, StopKind::Controlled);
  EXPECT_EQ(device.stop_within, 200ms);
  ASSERT_TRUE(device.enable);
  EXPECT_EQ(device.enable->transfer, Transfer::SharedMemory);
  EXPECT_EQ(device.enable->address, "orbiter-robot-enable");
  EXPECT_EQ(device.enable->byte_order, ByteOrder::Little);
  EXPECT_TRUE(actuators_without_enable(robot).empty());
  const SubsystemDescriptor stick = read_subsystem(data / "flywheel.xml", file_system()).value.value();
  EXPECT_EQ(stick.devices.at(0).stop, StopKind::Drop);
  EXPECT_FALSE(stick.devices.at(0).enable);
  EXPECT_TRUE(actuators_without_enable(stick).empty()) << "it is no actuator";
  SubsystemDescriptor bare = robot;
  bare.devices.at(0).enable.reset();
  EXPECT_EQ(actuators_without_enable(bare), std::vector<std::string_view>{"PLATE"});
}

TEST(SubsystemDescriptor, FillsTheConfiguration) {
  const SubsystemDescriptor robot = read_subsystem(data / "coronagraph.xml", file_system()).value.value();
  EXPECT_EQ(robot.find_configuration("STANDALONE")->overruns.reduced, 20U);
  const Configuration* coupled = robot.find_configuration(std::uint8_t{2});
  ASSERT_NE(coupled, nullptr);
  EXPECT_EQ(coupled->name, "COUPLED");
  EXPECT_EQ(coupled->priority, 80);
  EXPECT_EQ(coupled->sampling, 500us);
  EXPECT_EQ(coupled->self_test, SelfTest::Required);
  EXPECT_EQ(coupled->self_test_within, 2s);
  EXPECT_EQ(robot.find_configuration("STANDALONE")->self_test, SelfTest::Optional);
  const Provides& state = coupled->provides.at(0);
  EXPECT_EQ(state.terms.methods, std::vector{LinkMethod::SharedMemory});
  EXPECT_EQ(state.parameters.at(0).member, 1);
  EXPECT_EQ(fields_of(robot, state.parameters.at(1)).at(0).name, "TORQUE") << "an unqualified member";
  const Requires& stick = coupled->requires_.at(0);
  EXPECT_FALSE(stick.required);
  EXPECT_EQ(stick.from, "FLYWHEEL");
  EXPECT_EQ(stick.age.realtime, 4U);
  EXPECT_EQ(stick.age.reduced, 40U);
  EXPECT_EQ(stick.missing, MissingPolicy::Hold);
  EXPECT_EQ(stick.fields.size(), 2U);
  const DeviceUse& use = coupled->devices.at(0);
  EXPECT_EQ(robot.devices.at(use.device).output.at(0).safe, (std::vector<double>{0, 0}));
  EXPECT_TRUE(robot.devices.at(use.device).actuator);
  EXPECT_EQ(use.silence.reduced, 60U);
  EXPECT_EQ(use.watchdog_us, 7500U);
  EXPECT_EQ(use.watchdog_reduced_us, 40'000U);
  EXPECT_EQ(use.settings.at(0).value, "4000");
  EXPECT_EQ(use.endnode.address, "orbiter-robot");
  EXPECT_EQ(coupled->initial.at(1).values, (std::vector<Value>{-0.8, 1.6}));
}

TEST(SubsystemDescriptor, AConfigurationMayWaitForASelfTestWhoseTimeItOrTheSubsystemSays) {
  const auto configuration = [](const std::string& of_subsystem, const std::string& attributes,
                                const std::string& of_configuration) {
    const auto reading = testing::read_text("<Subsystem name=\"S\" id=\"10\">" + of_subsystem +
                                            "<Configuration name=\"C\" id=\"1\" sampling_us=\"100\" " + attributes +
                                            ">" + of_configuration + "</Configuration></Subsystem>");
    return reading.value.value().configurations.front();
  };
  const Configuration silent = configuration("", "", "");
  EXPECT_EQ(silent.self_test, SelfTest::Optional);
  EXPECT_EQ(silent.self_test_within, 10s);
  EXPECT_EQ(configuration("", R"(self_test="optional")", "").self_test, SelfTest::Optional);
  EXPECT_EQ(configuration("", R"(self_test="required")", "").self_test, SelfTest::Required)
      << "without an actuator, too";
  const char* both = R"(<TestService self_test_within_ms="2000"/>)";
  EXPECT_EQ(configuration(both, "", "").self_test_within, 2s);
  EXPECT_EQ(configuration(both, "", "<TestService/>").self_test_within, 2s);
  EXPECT_EQ(configuration(both, "", R"(<TestService self_test_within_ms="600000"/>)").self_test_within, 600s);
  EXPECT_EQ(configuration("<TestService/>", "", R"(<TestService self_test_within_ms="1"/>)").self_test_within, 1ms);
}

TEST(SubsystemDescriptor, ALinkServiceOfTheSubsystemHoldsInEveryConfiguration) {
  const auto reading = read_text(R"(<Subsystem name="S" id="10"><Configuration name="A" id="1" sampling_us="100"/>
    <Configuration name="B" id="2" sampling_us="100"/><ParamRef name="X" id="1" type="FLOAT"/>
    <RealTimeLinkService><Provides name="P"><ParamRef name="X"/></Provides></RealTimeLinkService></Subsystem>)");
  ASSERT_TRUE(reading.value);
  EXPECT_EQ(reading.value->configurations.at(0).provides.at(0).name, "P");
  EXPECT_EQ(reading.value->configurations.at(1).provides.at(0).name, "P");
}

TEST(SubsystemDescriptor, ALentSetHasLargeFieldsOfItsOwnAndTheByteOrderOfTheMachine) {
  const auto reading = read_text(R"(<Subsystem name="S" id="10"><Configuration name="A" id="1" sampling_us="100"/>
    <RealTimeLinkService><Provides name="P" kind="loaned" byte_order="native"><Field name="N" type="UINT64"/>
    <Field name="X" type="UINT8" count="1048576" unit="1"/></Provides>
    <Requires name="R" kind="loaned"><Field name="X" type="FLOAT" count="4194304"/></Requires></RealTimeLinkService></Subsystem>)");
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const Provides& provides = reading.value->configurations.at(0).provides.at(0);
  EXPECT_TRUE(provides.terms.lent());
  EXPECT_TRUE(provides.parameters.empty());
  ASSERT_EQ(provides.fields.size(), 2U);
  EXPECT_EQ(provides.fields.at(1).count, 1'048'576U);
  EXPECT_EQ(provides.fields.at(1).unit, "1");
  const Requires& wanted = reading.value->configurations.at(0).requires_.at(0);
  EXPECT_EQ(wanted.terms.byte_orders, provides.terms.byte_orders);
  EXPECT_EQ(wanted.fields.at(0).count, 4'194'304U);
}

TEST(SubsystemDescriptor, AQueuedSetSaysHowDeepItIs) {
  const auto reading =
      read_text(R"(<Subsystem name="S" id="10"><Parameters><ParamRef name="X" id="1" type="DOUBLE"/></Parameters>
    <Configuration name="A" id="1" sampling_us="100"/><RealTimeLinkService>
    <Provides name="P" kind="latest queued"><ParamRef name="X"/></Provides>
    <Requires name="Q" kind="queued"><Field name="X" type="DOUBLE"/></Requires>
    <Requires name="R" kind="queued" depth="4096"><Field name="X" type="DOUBLE" count="2048"/></Requires>
    <Requires name="S"><Field name="X" type="DOUBLE"/></Requires></RealTimeLinkService></Subsystem>)");
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  const Configuration& configuration = reading.value->configurations.at(0);
  EXPECT_EQ(configuration.provides.at(0).terms.kinds, (std::vector{LinkKind::Latest, LinkKind::Queued}));
  EXPECT_EQ(configuration.requires_.at(0).kind(), LinkKind::Queued);
  EXPECT_EQ(configuration.requires_.at(0).depth, default_link_depth);
  EXPECT_EQ(configuration.requires_.at(1).depth, 4096U);
  EXPECT_EQ(configuration.requires_.at(2).kind(), LinkKind::Latest);
  EXPECT_EQ(configuration.requires_.at(2).depth, 0U);
}

TEST(SubsystemDescriptor, AcceptsTheSmallestUsefulSubsystem) {
  const auto reading = read_subsystem(data / "hello.xml", file_system());
  ASSERT_TRUE(reading.value) << rendered(reading.problems, file_system());
  EXPECT_NE(reading.value->find_function("MOVE_TO"), nullptr);
}

TEST(SubsystemDescriptor, EveryTruncationIsRefused) {
  std::string text = file_system()(data / "coronagraph.xml").value();
  while (text.ends_with('\n')) text.pop_back();
  ASSERT_TRUE(read_text(text).value);
  for (std::size_t octets = 0; octets < text.size(); octets += hirosco::testing::one_in(std::size_t{7})) {
    const auto reading = read_text(text.substr(0, octets));
    EXPECT_FALSE(reading.value) << octets;
    EXPECT_FALSE(reading.problems.empty()) << octets;
  }
}

TEST(SubsystemDescriptor, HostileDocumentsAreRefusedWithAPlace) {
  const auto refused = [](const std::string& text, std::string_view code) {
    const auto reading = read_text(text);
    ASSERT_FALSE(reading.problems.empty());
    EXPECT_EQ(reading.problems[0].code, code);
    EXPECT_GE(reading.problems[0].at.line, 1);
  };
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<Subsystem>";
  refused(deep, "E0004");
  refused("<Subsystem name=\"" + std::string(16U << 20, 'x') + "\"/>", "E0004");
  refused("<Subsystem name=\"\xC3\"/>", "E0002");
  refused(std::string("<Subsystem\0/>", 13), "E0002");
  refused("<!DOCTYPE Subsystem [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;\">]><Subsystem name=\"&b;\"/>", "E0003");
}

TEST(SubsystemDescriptor, CountsAreBounded) {
  const auto configurations = [](int count) {
    std::string text = "<Subsystem name=\"S\" id=\"1\">";
    for (int i = 1; i <= count; ++i) {
      const std::string id = std::to_string(i);
      text += "<Configuration name=\"C" + id + "\" id=\"" + id + "\" sampling_us=\"100\"/>";
    }
    return text + "</Subsystem>";
  };
  EXPECT_TRUE(read_text(configurations(64)).value);
  EXPECT_EQ(read_text(configurations(65)).problems.at(0).code, "E0107");
  const auto provided = [](int members) {
    std::string text = "<Subsystem name=\"S\" id=\"10\"><StructRef name=\"A\" id=\"0\">";
    for (int i = 1; i <= members; ++i) {
      const std::string id = std::to_string(i);
      text += "<ParamRef name=\"M" + id + "\" id=\"" + id + "\" type=\"INT8\"/>";
    }
    return text +
           "</StructRef><RealTimeLinkService><Provides name=\"P\"><ParamRef name=\"A\"/></Provides>"
           "</RealTimeLinkService></Subsystem>";
  };
  EXPECT_TRUE(read_text(provided(64)).value);
  EXPECT_EQ(read_text(provided(65)).problems.at(0).code, "E0215");
}

TEST(SubsystemDescriptor, ManyProblemsEndTheReading) {
  std::string text = "<Subsystem name=\"S\" id=\"1\">";
  for (int i = 0; i < 40'000 / hirosco::testing::one_in(10); ++i)
    text += "<ParamRef name=\"X\" id=\"1\" type=\"INTT8\"/>";
  EXPECT_EQ(read_text(text + "</Subsystem>").problems.size(), 200U);
}

TEST(SubsystemReader, ADeviceMayHaveSeveralEndnodesWithFallBacksAndAPowerSwitch) {
  const auto reading = read_text(R"(<Subsystem name="S" id="10">
    <Device name="CAMERA">
      <Endnode name="DRIVE" actuator="yes" stop="hold"><Output><Field name="ANGLE" type="DOUBLE" safe="0"/></Output>
        <Enable transfer="unix" address="enable"/></Endnode>
      <Endnode name="IMAGE"><Input><Field name="PIXELS" type="UINT8" count="8"/></Input></Endnode>
      <Power transfer="unix" address="power"/>
    </Device>
    <Device name="LAMP"><Output><Field name="ON" type="UINT8"/></Output><Power transfer="unix" address="lamp_power"/></Device>
    <Configuration name="C" id="1" sampling_us="1000">
      <Device name="CAMERA" silence="5" silence_reduced="30" watchdog_ms="20">
        <Endnode name="IMAGE" transfer="udp" address="127.0.0.1:5001" byte_order="big" every="10" silence="40" silence_reduced="90">
          <FallBack transfer="unix" address="image2"/>
          <FallBack transfer="shared_memory" address="image3"/>
        </Endnode>
        <Endnode name="DRIVE" transfer="unix" address="drive"><Setting name="GAIN" value="3"/></Endnode>
      </Device>
      <Device name="LAMP"><Endnode transfer="unix" address="lamp"><FallBack transfer="unix" address="lamp2"/></Endnode></Device>
    </Configuration>
  </Subsystem>)");
  ASSERT_TRUE(reading.value);
  const SubsystemDescriptor& read = *reading.value;
  ASSERT_EQ(read.devices.size(), 3U);
  EXPECT_EQ(read.devices[0].name, "CAMERA.DRIVE");
  EXPECT_EQ(read.devices[0].part_of, "CAMERA");
  EXPECT_TRUE(read.devices[0].actuator);
  EXPECT_EQ(read.devices[0].enable->address, "enable");
  EXPECT_EQ(read.devices[1].name, "CAMERA.IMAGE");
  EXPECT_EQ(read.devices[2].part_of, "") << "one endnode is the simple case";
  ASSERT_EQ(read.power_switches.size(), 2U);
  EXPECT_EQ(read.power_switches[0].device, "CAMERA");
  EXPECT_EQ(read.power_switches[0].endnode.address, "power");
  EXPECT_EQ(read.power_switches[1].device, "LAMP");
  const auto& uses = read.configurations.at(0).devices;
  ASSERT_EQ(uses.size(), 3U);
  EXPECT_EQ(uses[0].device, 1);
  EXPECT_EQ(uses[0].every, 10U);
  EXPECT_EQ(uses[0].silence.realtime, 40U);
  EXPECT_EQ(uses[0].watchdog_us, 20'000U) << "of its device";
  ASSERT_EQ(uses[0].fall_backs.size(), 2U);
  EXPECT_EQ(uses[0].fall_backs[0].address, "image2");
  EXPECT_EQ(uses[0].fall_backs[1].transfer, Transfer::SharedMemory);
  EXPECT_EQ(uses[0].fall_backs[1].byte_order, ByteOrder::Big);
  EXPECT_EQ(uses[1].device, 0);
  EXPECT_EQ(uses[1].silence.realtime, 5U) << "of its device";
  EXPECT_EQ(uses[1].settings.at(0).name, "GAIN");
  EXPECT_EQ(uses[2].fall_backs.at(0).address, "lamp2");
  const auto has = [&](std::uint16_t id, std::string_view name) {
    return std::ranges::any_of(read.events, [&](const Event& event) { return event.id == id && event.name == name; });
  };
  EXPECT_TRUE(has(0xF100, "CAMERA_DRIVE_LOST"));
  EXPECT_TRUE(has(0xF301, "CAMERA_IMAGE_FALL_BACK"));
  EXPECT_TRUE(has(0xF302, "LAMP_FALL_BACK"));
  EXPECT_EQ(read.find_event("CAMERA_DRIVE_FALL_BACK"), nullptr) << "it has none";
}

}  // namespace
}  // namespace hirosco::descriptor
