// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "hirosco/descriptor/testing.hpp"

/// Whom a subsystem may command, from its descriptor to its process.
namespace hirosco::descriptor {
namespace {

using testing::changed;
using testing::data;
using testing::overlay;
using testing::read_text;
using testing::rendered;

std::string commanding(const std::string& commands) {
  return R"(<Subsystem name="PORTER" id="40">)" + commands +
         R"(<Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)";
}
constexpr const char* bell = R"(<Subsystem name="BELL" id="41">
  <CustomService name="RINGING" type="200"><Request name="COUNT_RINGS" subtype="1"/></CustomService>
  <Configuration name="ONE" id="1" sampling_us="1000"><FunctionService><Function name="RING"/></FunctionService></Configuration>
</Subsystem>)";

/// The good mission with a porter and two bells more.
FileSource with_porter(const std::string& commands, const std::string& inside = "") {
  const std::string first = R"(<Subsystem executable="hirosco-flywheel" descriptor="flywheel.xml"/>)";
  return overlay({{"mission.xml", changed(first, first + R"(
    <Subsystem executable="porter" descriptor="porter.xml">)" +
                                                     inside + R"(</Subsystem>
    <Subsystem executable="bell" descriptor="bell.xml"/>
    <Subsystem executable="bell" descriptor="bell.xml" name="BIG_BELL" id="42"/>)")},
                  {"porter.xml", commanding(commands)},
                  {"bell.xml", bell}});
}
constexpr const char* rings = R"(<Commands subsystem="BELL" functions="RING COUNT_RINGS"/>)";

std::string first_problem(const FileSource& source) {
  const auto reading = read_mission(data / "mission.xml", source);
  return reading.problems.empty() ? std::string{} : reading.problems.front().code;
}

TEST(Commands, NameWhoIsCommandedAndForWhat) {
  const auto reading = read_text(commanding(rings));
  ASSERT_TRUE(reading.value);
  ASSERT_EQ(reading.value->commands.size(), 1U);
  EXPECT_EQ(reading.value->commands[0].subsystem, "BELL");
  EXPECT_EQ(reading.value->commands[0].functions, (std::vector<std::string>{"RING", "COUNT_RINGS"}));
  EXPECT_EQ(reading.value->commands[0].apid, 0) << "no mission has said who that is";
}

TEST(Commands, OfAnotherFormAreRefused) {
  const auto problem = [](const std::string& commands) {
    const auto reading = read_text(commanding(commands));
    return reading.problems.empty() ? std::string{} : reading.problems.front().code;
  };
  EXPECT_EQ(problem(std::string{rings} + rings), "E0201");
  EXPECT_EQ(problem(R"(<Commands subsystem="BELL" functions="RING RING"/>)"), "E0201");
  EXPECT_EQ(problem(R"(<Commands subsystem="BELL" functions=" "/>)"), "E0109");
  EXPECT_EQ(problem(R"(<Commands subsystem="BELL"/>)"), "E0105");
  EXPECT_EQ(problem(R"(<Commands functions="RING"/>)"), "E0105");
}

TEST(Commands, AMissionSaysWhoThatIsAndItsProcessIsToldTheSame) {
  for (const bool redirected : {false, true}) {
    const auto source = with_porter(rings, redirected ? R"(<Commands subsystem="BELL" to="BIG_BELL"/>)" : "");
    const auto reading = read_mission(data / "mission.xml", source);
    ASSERT_TRUE(reading.value) << rendered(reading.problems, source);
    const MissionSubsystem* porter = reading.value->find_subsystem("PORTER");
    ASSERT_NE(porter, nullptr);
    const Commands& commands = porter->subsystem.commands.at(0);
    EXPECT_EQ(commands.apid, redirected ? 42 : 41);
    ASSERT_EQ(commands.requests.size(), 2U);
    EXPECT_EQ(commands.requests[0].service, 8);
    EXPECT_EQ(commands.requests[1].service, 200);

    SubsystemDescriptor launched = read_subsystem(data / "porter.xml", source).value.value();
    const auto changes = changes_of(*porter);
    const auto told = std::ranges::find(changes, "--commands", &std::pair<std::string, std::string>::first);
    ASSERT_NE(told, changes.end());
    ASSERT_TRUE(apply_commands(launched, told->second, source)) << told->second;
    EXPECT_EQ(launched.commands[0].apid, commands.apid);
    ASSERT_EQ(launched.commands[0].requests.size(), 2U);
    EXPECT_EQ(launched.commands[0].requests[1].name, "COUNT_RINGS");
  }
}

TEST(Commands, OfSomebodyWhoIsNotThereOrForWhatThatDoesNotHaveAreRefused) {
  EXPECT_EQ(first_problem(with_porter(R"(<Commands subsystem="GONG" functions="RING"/>)")), "E0304");
  EXPECT_EQ(first_problem(with_porter(R"(<Commands subsystem="PORTER" functions="RING"/>)")), "E0304") << "itself";
  EXPECT_EQ(first_problem(with_porter(R"(<Commands subsystem="BELL" functions="MELT"/>)")), "E0310");
  EXPECT_EQ(first_problem(with_porter(R"(<Commands subsystem="BELL" functions="SET_STATE"/>)")), "E0310")
      << "states are nobody's to declare";
  EXPECT_EQ(first_problem(with_porter(rings, R"(<Commands subsystem="GONG" to="BELL"/>)")), "E0304");
  EXPECT_EQ(first_problem(with_porter(rings, R"(<Commands subsystem="BELL" to="GONG"/>)")), "E0304");
  EXPECT_EQ(first_problem(with_porter(rings, R"(<Commands subsystem="BELL" to="PORTER"/>)")), "E0304");
  EXPECT_EQ(first_problem(with_porter(rings, R"(<Commands subsystem="BELL"/>)")), "E0105");
  const std::string twice = R"(<Commands subsystem="BELL" to="BIG_BELL"/>)";
  EXPECT_EQ(first_problem(with_porter(rings, twice + twice)), "E0201");
}

constexpr const char* chime = R"(<Subsystem name="CHIME" id="43">
  <Parameters><ParamRef name="PITCH" id="1" type="DOUBLE" minimum="0" maximum="1" writable="Operational"/><ParamRef name="SWING" id="2" type="FLOAT"/></Parameters>
  <Configuration name="ONE" id="1" sampling_us="1000">
    <HKService id="4900" interval="10"><SampledOnce><ParamRef name="SWING"/></SampledOnce></HKService>
    <HKService id="4902" interval="10"><SampledOnce><ParamRef name="PITCH"/></SampledOnce><SampledNREPTimes nrep="2"><ParamRef name="SWING"/></SampledNREPTimes></HKService>
    <EventService><Event name="CRACKED" id="4901" severity="low"/></EventService>
  </Configuration>
</Subsystem>)";
FileSource with_listener(const std::string& says, const std::string& inside = "") {
  const std::string first = R"(<Subsystem executable="hirosco-flywheel" descriptor="flywheel.xml"/>)";
  return overlay({{"mission.xml", changed(first, first + R"(
    <Subsystem executable="porter" descriptor="porter.xml">)" +
                                                     inside + R"(</Subsystem>
    <Subsystem executable="chime" descriptor="chime.xml"/>
    <Subsystem executable="chime" descriptor="chime.xml" name="OTHER" id="44"/>)")},
                  {"porter.xml", commanding(says)},
                  {"chime.xml", chime}});
}

TEST(Subscribes, AMissionSaysWhoseAndItsProcessIsToldTheSame) {
  const std::string says =
      R"(<Subscribes subsystem="CHIME" housekeeping="4900" events="CRACKED"/>)"
      R"(<Commands subsystem="CHIME" sets="PITCH" reads="SWING" housekeeping="4900" events="CRACKED"/>)";
  for (const bool redirected : {false, true}) {
    const std::string inside = redirected ? R"(<Subscribes subsystem="CHIME" to="OTHER"/>)" : "";
    const auto source = with_listener(says, inside);
    const auto reading = read_mission(data / "mission.xml", source);
    ASSERT_TRUE(reading.value) << rendered(reading.problems, source);
    const auto* porter = reading.value->find_subsystem("PORTER");
    const Subscribes& heard = porter->subsystem.subscribes.at(0);
    EXPECT_EQ(heard.apid, redirected ? 44 : 43);
    ASSERT_EQ(heard.things.size(), 2U);
    EXPECT_EQ(heard.things[0].id, 4900U);
    EXPECT_EQ(heard.things[0].fields.size(), 1U);
    EXPECT_EQ(heard.things[1].id, 4901U);
    const Commands& commands = porter->subsystem.commands.at(0);
    EXPECT_EQ(commands.apid, 43) << "each element for itself";
    EXPECT_EQ(commands.things.at(0).id, (ParameterId{43, Type::Double, 1}.wire()));
    SubsystemDescriptor launched = *read_text(commanding(says)).value;
    for (const auto& [word, text] : changes_of(*porter)) {
      const auto applied =
          needs_other(word) ? apply_other(launched, word, text, source) : apply_change(launched, word, text);
      ASSERT_TRUE(applied) << word << " " << text;
    }
    EXPECT_EQ(launched.subscribes[0].apid, heard.apid);
    EXPECT_EQ(launched.subscribes[0].things[0].id, 4900U);
    EXPECT_EQ(launched.commands[0].things[0].id, commands.things[0].id);
  }
}

TEST(Subscribes, OfAnotherFormOrWhatNobodyHasAreRefused) {
  const auto problem = [](const std::string& says, const std::string& inside = "") {
    return first_problem(with_listener(says, inside));
  };
  EXPECT_EQ(problem(R"(<Subscribes subsystem="CHIME"/>)"), "E0105");
  EXPECT_EQ(problem(R"(<Subscribes subsystem="CHIME" events=" "/>)"), "E0109");
  EXPECT_EQ(problem(R"(<Subscribes subsystem="CHIME" events="CRACKED CRACKED"/>)"), "E0201");
  EXPECT_EQ(problem(R"(<Subscribes subsystem="CHIME" events="MELTED"/>)"), "E0310");
  EXPECT_EQ(problem(R"(<Subscribes subsystem="CHIME" housekeeping="4999"/>)"), "E0310");
  EXPECT_EQ(problem(R"(<Subscribes subsystem="CHIME" housekeeping="4902"/>)"), "E0310") << "sampled several times";
  EXPECT_EQ(problem(R"(<Commands subsystem="CHIME" sets="SWING"/>)"), "E0310") << "never writable";
  EXPECT_EQ(problem(R"(<Commands subsystem="CHIME" reads="SWINGS"/>)"), "E0310");
  EXPECT_EQ(problem(R"(<Subscribes subsystem="GONG" events="CRACKED"/>)"), "E0304");
  EXPECT_EQ(problem(R"(<Subscribes subsystem="PORTER" events="CRACKED"/>)"), "E0304") << "itself";
  EXPECT_EQ(problem(R"(<Commands subsystem="CHIME" reads="SWING"/>)", R"(<Subscribes subsystem="CHIME" to="OTHER"/>)"),
            "E0304")
      << "it hears nobody";
}

/// The good mission's supervisor with functions, and a structure of which each member of the mission has a row.
const std::string supervising = R"(<FunctionService>
    <Function name="SET_MODE"><Argument name="MODE" type="UINT8" minimum="1" maximum="255"/></Function>
    <Function name="SHUTDOWN" essential="yes"/>
  </FunctionService>
  <StructRef name="SUBSYSTEMS" id="4" type="STRUCT"><ParamRef name="APID" id="130" type="UINT16" count="2"/></StructRef>
  <Configuration name="NORMAL" id="1" sampling_us="10000">
    <HKService id="4701" interval="100"><SampledOnce><ParamRef name="MODE"/></SampledOnce></HKService>
    <HKService id="4702" interval="100"><SampledOnce><ParamRef name="MODE"/><ParamRef name="SUBSYSTEMS"/></SampledOnce></HKService>
  </Configuration>)";
FileSource with_adviser(const std::string& says, const std::string& inside = "") {
  const std::string first = R"(<Subsystem executable="hirosco-flywheel" descriptor="flywheel.xml"/>)";
  const std::string plain = R"(<Configuration name="NORMAL" id="1" sampling_us="10000"/>)";
  return overlay({{"mission.xml", changed(first, first + R"(
    <Subsystem executable="porter" descriptor="porter.xml">)" +
                                                     inside + "</Subsystem>")},
                  {"porter.xml", commanding(says)},
                  {"supervisor.xml", changed(plain, supervising, file_system()(data / "supervisor.xml").value())}});
}

TEST(Commands, OfTheSupervisorAreLikeThoseOfEveryOtherMember) {
  const auto says = [](const std::string& whom) {
    return R"(<Commands subsystem=")" + whom + R"(" functions="SET_MODE" reads="MODE" housekeeping="4701"/>)" +
           R"(<Subscribes subsystem=")" + whom + R"(" housekeeping="4701" events="RECOVERY_STEP"/>)" +
           R"(<ParamRef name="SEEN" id="1" type="UINT8" from=")" + whom + R"(.MODE" age_ms="1000"/>)";
  };
  const std::string meant =
      R"(<Commands subsystem="BOSS" to="SUPERVISOR"/><Subscribes subsystem="BOSS" to="SUPERVISOR"/>)";
  for (const auto& [whom, inside] : {std::pair<std::string, std::string>{"SUPERVISOR", ""}, {"BOSS", meant}}) {
    const auto source = with_adviser(says(whom), inside);
    const auto reading = read_mission(data / "mission.xml", source);
    ASSERT_TRUE(reading.value) << rendered(reading.problems, source);
    const MissionSubsystem* porter = reading.value->find_subsystem("PORTER");
    const Commands& commands = porter->subsystem.commands.at(0);
    EXPECT_EQ(commands.apid, 1);
    ASSERT_EQ(commands.requests.size(), 1U);
    EXPECT_EQ(commands.things.at(0).id, (ParameterId{1, Type::Uint8, 1}.wire()));
    SubsystemDescriptor launched = *read_text(commanding(says(whom))).value;
    for (const auto& [word, text] : changes_of(*porter)) {
      const auto applied =
          needs_other(word) ? apply_other(launched, word, text, source) : apply_change(launched, word, text);
      ASSERT_TRUE(applied) << word << " " << text;
    }
    for (const SubsystemDescriptor* each : {&porter->subsystem, &std::as_const(launched)}) {
      EXPECT_EQ(each->commands.at(0).requests.at(0).name, "SET_MODE");
      EXPECT_EQ(each->subscribes.at(0).apid, 1);
      EXPECT_EQ(each->subscribes.at(0).things.at(1).id, 105U);
      EXPECT_EQ(each->subscribes.at(0).foreign.at(0).structure, 4701);
    }
  }
}

TEST(Commands, OfTheSupervisorForWhatIsTheGroundsAloneAreRefused) {
  EXPECT_EQ(first_problem(with_adviser(R"(<Commands subsystem="SUPERVISOR" functions="SET_MODE"/>)")), "");
  EXPECT_EQ(first_problem(with_adviser(R"(<Commands subsystem="SUPERVISOR" functions="SET_MODE SHUTDOWN"/>)")),
            "E0357");
  EXPECT_EQ(first_problem(with_adviser(R"(<Commands subsystem="SUPERVISOR" functions="SET_STATE"/>)")), "E0310");
}

/// Its process reads the file, in which they are two.
TEST(Subscribes, OfTheSupervisorThatHaveMoreRowsInTheMissionThanInItsDescriptorAreRefused) {
  for (const char* says : {R"(<Subscribes subsystem="SUPERVISOR" housekeeping="4702"/>)",
                           R"(<Commands subsystem="SUPERVISOR" housekeeping="4702"/>)",
                           R"(<Commands subsystem="SUPERVISOR" reads="SUBSYSTEMS"/>)"})
    EXPECT_EQ(first_problem(with_adviser(says)), "E0310") << says;
  EXPECT_EQ(first_problem(with_adviser(R"(<Commands subsystem="SUPERVISOR" reads="MODE"/>)")), "");
}

TEST(Commands, WordsOfAnotherFormForAProcessAreRefused) {
  const auto source = with_porter(rings);
  SubsystemDescriptor porter = read_subsystem(data / "porter.xml", source).value.value();
  for (const char* text : {"", "BELL", "BELL=", "BELL=41", "BELL=x:bell.xml", "BELL=70000:bell.xml", ":41=bell.xml"})
    EXPECT_EQ(apply_commands(porter, text, source).error().code, ErrorCode::InvalidArgument) << text;
  for (const char* text : {"GONG=41:bell.xml", "BELL=41:none.xml", "BELL=41:porter.xml"})
    EXPECT_EQ(apply_commands(porter, text, source).error().code, ErrorCode::NotFound) << text;
}

TEST(Scripts, AreNamedByADescriptorEachOnceWithTheirFiles) {
  const auto reading = read_text(commanding(R"(<Script name="OUT" file="out.script"/><Script name="BACK" file="b"/>)"));
  ASSERT_TRUE(reading.value);
  ASSERT_EQ(reading.value->scripts.size(), 2U);
  EXPECT_EQ(reading.value->scripts[0].name, "OUT");
  EXPECT_EQ(reading.value->scripts[0].file, "out.script");
  const auto code_of = [](const char* script) {
    const auto wrong = read_text(commanding(script));
    return wrong.problems.empty() ? std::string{} : wrong.problems.front().code;
  };
  EXPECT_EQ(code_of(R"(<Script name="OUT" file="a"/><Script name="OUT" file="b"/>)"), "E0201");
  EXPECT_EQ(code_of(R"(<Script name="OUT" file=""/>)"), "E0109");
  EXPECT_EQ(code_of(R"(<Script name="OUT"/>)"), "E0105");
}

}  // namespace
}  // namespace hirosco::descriptor
