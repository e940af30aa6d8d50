// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/testing.hpp"

/// Parameters with the values of other subsystems (docs/adr/0103), from the descriptor to the process.
namespace hirosco::descriptor {
namespace {

using testing::changed;
using testing::data;
using testing::overlay;
using testing::read_text;
using testing::rendered;

constexpr const char* bus_text = R"(<Subsystem name="BUS" id="41">
  <StructRef name="STATE" id="0">
    <ParamRef name="SWITCHED" id="0" type="BOOL"/>
    <StructRef name="MAIN" id="1">
      <ParamRef name="VOLTAGE" id="0" type="DOUBLE" unit="V"/><ParamRef name="CURRENT" id="1" type="DOUBLE" unit="A"/>
    </StructRef>
  </StructRef>
  <ParamRef name="CHARGE" id="2" type="DOUBLE"/>
  <ParamRef name="HIDDEN" id="3" type="DOUBLE"/>
  <HKService id="4801" interval="100"><SampledOnce><ParamRef name="CHARGE"/><ParamRef name="STATE"/></SampledOnce></HKService>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";

std::string heater_text(const std::string& body,
                        const std::string& heard = R"(<Subscribes subsystem="POWER" housekeeping="4801"/>)") {
  return R"(<Subsystem name="HEATER" id="40">)" + heard + body +
         R"(<Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)";
}
constexpr const char* heard_voltage =
    R"(<ParamRef name="VOLTAGE" id="1" type="DOUBLE" unit="V" from="POWER.STATE.MAIN.VOLTAGE" age_ms="300"/>)";

/// The good mission with a bus and a heater that calls it POWER.
FileSource with_heater(const std::string& text, const std::string& other = bus_text) {
  const std::string first = R"(<Subsystem executable="hirosco-flywheel" descriptor="flywheel.xml"/>)";
  return overlay({{"mission.xml", changed(first, first + R"(
    <Subsystem executable="heater" descriptor="heater.xml"><Subscribes subsystem="POWER" to="BUS"/></Subsystem>
    <Subsystem executable="bus" descriptor="bus.xml"/>)")},
                  {"heater.xml", text},
                  {"bus.xml", other}});
}
std::string mission_problem(const FileSource& source) {
  const auto reading = read_mission(data / "mission.xml", source);
  return reading.problems.empty() ? std::string{}
                                  : reading.problems.front().code + " " + reading.problems.front().message;
}
bool has_code(const std::string& text, std::string_view code) { return text.starts_with(code); }

TEST(Foreign, HasItsPlaceInTheReportByWhichItIsHeard) {
  const auto source = with_heater(
      heater_text(std::string{heard_voltage} + R"(<StructRef name="BOTH" id="7" from="POWER.STATE.MAIN" age_ms="300">
        <ParamRef name="U" id="8" type="DOUBLE" unit="V"/><ParamRef name="I" id="9" type="DOUBLE" unit="A"/></StructRef>)"));
  const auto reading = read_mission(data / "mission.xml", source);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, source);
  const SubsystemDescriptor& subsystem = reading.value->find_subsystem("HEATER")->subsystem;
  const Subscribes& heard = subsystem.subscribes.front();
  ASSERT_EQ(heard.foreign.size(), 2u);
  // CHARGE has 8 octets, SWITCHED one: the heard_voltage stands behind them.
  EXPECT_EQ(heard.foreign[0].structure, 4801);
  EXPECT_EQ(heard.foreign[0].offset, 9u);
  EXPECT_EQ(heard.foreign[1].offset, 9u);
  EXPECT_EQ(subsystem.parameters[heard.foreign[1].parameter].field.name, "BOTH");
  EXPECT_NE(subsystem.find_event("FOREIGN_UNKNOWN"), nullptr);
}

TEST(Foreign, IsTheSameForTheProcess) {
  auto reading = read_text(heater_text(heard_voltage));
  ASSERT_TRUE(reading.value);
  EXPECT_EQ(reading.value->subscribes.front().foreign.front().structure, 0) << "nobody has said who POWER is";
  const auto source = overlay({{"bus.xml", bus_text}});
  ASSERT_TRUE(apply_other(*reading.value, "--subscribes", "POWER=41:bus.xml", source));
  EXPECT_EQ(reading.value->subscribes.front().foreign.front().structure, 4801);
  EXPECT_EQ(reading.value->subscribes.front().foreign.front().offset, 9u);
  auto other = read_text(heater_text(changed("VOLTAGE\" age", "TENSION\" age", heard_voltage)));
  ASSERT_TRUE(other.value);
  EXPECT_EQ(apply_other(*other.value, "--subscribes", "POWER=41:bus.xml", source).error().code, ErrorCode::Mismatch);
}

TEST(Foreign, OfWhomNothingIsHeardOrThatSomebodyElseSetsIsRefused) {
  const auto problem = [](const std::string& text) {
    const auto reading = read_text(text);
    return reading.problems.empty() ? std::string{} : reading.problems.front().code;
  };
  EXPECT_EQ(problem(heater_text(heard_voltage)), "");
  EXPECT_EQ(problem(heater_text(heard_voltage, "")), "E0254");
  EXPECT_EQ(problem(heater_text(heard_voltage, R"(<Subscribes subsystem="POWER" events="LOW"/>)")), "E0254");
  EXPECT_EQ(problem(heater_text(changed(" age_ms=\"300\"", "", heard_voltage))), "E0105");
  EXPECT_EQ(problem(heater_text(changed("POWER.STATE.MAIN.VOLTAGE", "POWER", heard_voltage))), "E0110");
  EXPECT_EQ(problem(heater_text(changed(" from=\"POWER.STATE.MAIN.VOLTAGE\"", "", heard_voltage))), "E0255");
  EXPECT_EQ(problem(heater_text(
                changed(" age_ms", " minimum=\"0\" maximum=\"1\" writable=\"Operational\" age_ms", heard_voltage))),
            "E0255");
  EXPECT_EQ(problem(heater_text(changed(" age_ms", " protection=\"yes\" age_ms", heard_voltage))), "E0255");
  EXPECT_EQ(problem(changed("sampling_us=\"1000\"/>",
                            "sampling_us=\"1000\"><Set parameter=\"VOLTAGE\" value=\"1\"/></Configuration>",
                            heater_text(heard_voltage))),
            "E0255");
}

TEST(Foreign, ThatTheOtherDoesNotTellIsRefusedWithTheReason) {
  const auto with = [](const std::string& from, const std::string& to) {
    return mission_problem(with_heater(heater_text(changed(from, to, heard_voltage))));
  };
  EXPECT_EQ(with(" age_ms", " age_ms"), "");
  EXPECT_TRUE(has_code(with("VOLTAGE\" age", "TENSION\" age"), "E0374")) << "there is none of this name";
  EXPECT_TRUE(has_code(with("STATE.MAIN.VOLTAGE", "HIDDEN"), "E0374")) << "it is reported by no structure";
  EXPECT_TRUE(has_code(with("unit=\"V\"", "unit=\"mV\""), "E0374"));
  EXPECT_TRUE(has_code(with("\"DOUBLE\"", "\"FLOAT\""), "E0374"));
  EXPECT_TRUE(has_code(with("\"DOUBLE\"", "\"DOUBLE\" count=\"2\""), "E0374"));
  EXPECT_TRUE(has_code(with("\"300\"", "\"99\""), "E0374")) << "each 100 ms it comes";
  EXPECT_EQ(with("\"300\"", "\"100\""), "");
}

TEST(Foreign, WhoseValueComesFromItselfIsRefused) {
  const std::string mirror = R"(<Subsystem name="BUS" id="41"><Subscribes subsystem="HEATER" housekeeping="4901"/>
    <ParamRef name="ECHO" id="2" type="DOUBLE" from="HEATER.LOUD" age_ms="500"/>
    <HKService id="4801" interval="100"><SampledOnce><ParamRef name="ECHO"/></SampledOnce></HKService>
    <Configuration name="ONE" id="1" sampling_us="1000"/></Subsystem>)";
  const auto loud = [](const std::string& from) {
    return heater_text(
        R"(<ParamRef name="LOUD" id="1" type="DOUBLE")" + from +
        R"(/><HKService id="4901" interval="100"><SampledOnce><ParamRef name="LOUD"/></SampledOnce></HKService>)");
  };
  EXPECT_EQ(mission_problem(with_heater(loud(""), mirror)), "") << "a chain that has an end";
  EXPECT_TRUE(has_code(mission_problem(with_heater(loud(R"( from="POWER.ECHO" age_ms="500")"), mirror)), "E0375"));
}

}  // namespace
}  // namespace hirosco::descriptor
