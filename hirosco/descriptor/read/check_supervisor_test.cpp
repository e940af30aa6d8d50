// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hirosco/descriptor/testing.hpp"

/// What the supervisor's own descriptor says is in force, or it is refused.
namespace hirosco::descriptor {
namespace {

const std::string bare_supervisor = R"(<Subsystem name="SUPERVISOR" id="1">INSIDE
  <Configuration name="NORMAL" id="1" sampling_us="10000"OF_IT/></Subsystem>)";

std::string own_text(const std::string& inside, const std::string& of_it = "") {
  return testing::changed("OF_IT", of_it, testing::changed("INSIDE", inside, bare_supervisor));
}

/// Refused at '@' in the supervisor's descriptor, and taken in the same text of somebody else.
void expect_not_of_supervisor(const std::string& text, const std::string& what) {
  const auto expected = testing::marked(text);
  const auto reading = testing::read_text(expected.text);
  ASSERT_EQ(reading.problems.size(), 1U) << testing::rendered(reading.problems, testing::text_source(expected.text));
  EXPECT_EQ(reading.problems[0].code, "E0332");
  EXPECT_EQ(reading.problems[0].at, expected.at) << text;
  EXPECT_EQ(reading.problems[0].message, what + " is not built in for the supervisor");
  const std::string other = testing::changed(R"(id="1")", R"(id="10")", expected.text);
  EXPECT_TRUE(testing::read_text(other).value)
      << testing::rendered(testing::read_text(other).problems, testing::text_source(other));
}

TEST(SupervisorsDescriptor, SaysNothingThatIsInForceForOthersOnly) {
  expect_not_of_supervisor(own_text(R"(@<Hang realtime="20"/>)"), "<Hang>");
  expect_not_of_supervisor(own_text(R"(@<Device name="D"><Input><Field name="Q" type="INT8"/></Input></Device>)"),
                           "<Device>");
  expect_not_of_supervisor(own_text(R"(@<Bumpless between="NORMAL OTHER"/>)"
                                    R"(<Configuration name="OTHER" id="2" sampling_us="10000"/>)"),
                           "<Bumpless>");
  expect_not_of_supervisor(own_text("", R"( priority="@50")"), "'priority' of <Configuration>");
  expect_not_of_supervisor(own_text("", R"( priority="@0")"), "'priority' of <Configuration>");
  for (const char* limit :
       {"memory_kB", "shared_memory_kB", "threads", "descriptors", "processor_percent", "ports", "files"})
    expect_not_of_supervisor(own_text("<Resources " + std::string{limit} + "=\"@65000\"/>"),
                             "'" + std::string{limit} + "' of <Resources>");
}

TEST(SupervisorsDescriptor, CommandsAndHearsNobodyByIt) {
  expect_not_of_supervisor(own_text(R"(@<Commands subsystem="NOBODY" functions="MOVE"/>)"), "<Commands>");
  expect_not_of_supervisor(own_text(R"(@<Subscribes subsystem="NOBODY" housekeeping="1"/>)"), "<Subscribes>");
  expect_not_of_supervisor(own_text(R"(@<Script name="WAY" file="way.txt"/>)"), "<Script>");
}

TEST(SupervisorsDescriptor, HasNoEndOfALink) {
  const std::string gives = R"(@<RealTimeLinkService><Provides name="STATE"><ParamRef name="Q"/></Provides>)";
  const std::string takes = R"(@<RealTimeLinkService><Requires name="GOAL"><Field name="Q" type="INT8"/></Requires>)";
  const std::string value = R"(<ParamRef name="Q" id="1" type="INT8"/>)", end = "</RealTimeLinkService>";
  for (const std::string& one : {gives + end, takes + end}) {
    expect_not_of_supervisor(own_text(value + one), "<RealTimeLinkService>");
    const std::string of_one = own_text(
        value, R"(/><Configuration name="OTHER" id="2" sampling_us="10000">)" + one + "</Configuration><Description");
    expect_not_of_supervisor(of_one, "<RealTimeLinkService>");
  }
}

TEST(SupervisorsDescriptor, HasNoServiceAndNoFailureOfItsOwn) {
  expect_not_of_supervisor(
      own_text(R"(@<CustomService name="WATCH" type="200"><Request name="LOOK" subtype="1"/></CustomService>)"),
      "<CustomService>");
  expect_not_of_supervisor(own_text(R"(@<Failure code="0x8001" name="TIRED"/>)"), "<Failure>");
}

TEST(SupervisorsDescriptor, HasNoSelfTestAndKeepsNoValues) {
  expect_not_of_supervisor(own_text("", R"( self_test="@required")"), "'self_test' of <Configuration>");
  expect_not_of_supervisor(own_text(R"(<TestService self_test_within_ms="@500"/>)"),
                           "'self_test_within_ms' of <TestService>");
  const std::string kept = R"( writable="PreOperational" minimum="0" maximum="9" persistent="@yes"/>)";
  const std::string value = R"(<ParamRef name="Q" id="1" type="INT8")" + kept;
  expect_not_of_supervisor(own_text(value), "'persistent' of <ParamRef>");
  expect_not_of_supervisor(own_text("<Parameters>" + value + "</Parameters>"), "'persistent' of <ParamRef>");
  expect_not_of_supervisor(own_text(R"(<StructRef name="S" id="1" writable="PreOperational" persistent="@yes">)"
                                    R"(<ParamRef name="Q" id="1" type="INT8" minimum="0" maximum="9"/></StructRef>)"),
                           "'persistent' of <StructRef>");
}

TEST(SupervisorsDescriptor, SaysNothingOfWhatItsFunctionsSet) {
  expect_not_of_supervisor(
      own_text(R"(<ParamRef name="Q" id="1" type="INT8"/><FunctionService><Function name="F" sets="@Q"/>)"
               "</FunctionService>"),
      "'sets' of <Function>");
}

/// All that is said of it, in the order of the file.
std::vector<std::string> messages_of(const std::string& text) {
  std::vector<std::string> messages;
  for (const Diagnostic& problem : testing::read_text(text).problems) messages.push_back(problem.message);
  return messages;
}

TEST(SupervisorsDescriptor, IsToldOfAllThatHangsTogetherAtOnce) {
  const std::string loop = R"(<ServiceLoop name="SLOW" period_us="1000"/><Service name="ST03" loop="SLOW"/>)";
  EXPECT_EQ(messages_of(own_text(loop)),
            (std::vector<std::string>{"<ServiceLoop> is not built in for the supervisor",
                                      "'loop' of <Service> is not built in for the supervisor"}));
  const std::string heard = R"(<Subscribes subsystem="OTHER" housekeeping="1"/>)";
  EXPECT_EQ(messages_of(own_text(heard + R"(<ParamRef name="Q" id="1" type="INT8" from="OTHER.Q" age_ms="100"/>)")),
            (std::vector<std::string>{"<Subscribes> is not built in for the supervisor",
                                      "'from' of <ParamRef> is not built in for the supervisor"}));
  const std::string set = R"(<RealTimeLinkService><Requires name="GO"><Field name="Q" type="INT8"/></Requires>)";
  EXPECT_EQ(messages_of(own_text(set + "</RealTimeLinkService>", R"( started_by="GO" least_us="100")")),
            (std::vector<std::string>{"<RealTimeLinkService> is not built in for the supervisor",
                                      "'started_by' of <Configuration> is not built in for the supervisor"}));
}

TEST(SupervisorsDescriptor, SpinsForNobody) {
  const auto reading = testing::read_text(own_text("", R"( priority="50" budget_us="10" spin_us="10")"));
  ASSERT_EQ(reading.problems.size(), 2U);
  EXPECT_EQ(reading.problems[1].message, "'spin_us' of <Configuration> is not built in for the supervisor");
}

TEST(SupervisorsDescriptor, HasNoPoolAndNoLoopThatReports) {
  expect_not_of_supervisor(own_text(R"(<Resources>@<Pool block="64" count="4"/></Resources>)"), "<Pool>");
  expect_not_of_supervisor(own_text(R"(<Resources channel_kB="@64"/>)"), "'channel_kB' of <Resources>");
  expect_not_of_supervisor(own_text(R"(<Resources loop_reports_kB="@64"/>)"), "'loop_reports_kB' of <Resources>");
}

TEST(SupervisorsDescriptor, HasQueuesParametersAndReportsAsEverybody) {
  const std::string text = own_text(
      R"(<Description>D</Description><Resources warning_percent="80" waiting_answers="512" cycle_events_kB="64"/>)"
      R"(<Enumeration name="WORDS"><Text value="0">none</Text></Enumeration><Service name="ST03" offered="yes"/>)"
      R"(<ParamRef name="Q" id="1" type="INT8" writable="PreOperational" minimum="0" maximum="9" init="1" enumeration="WORDS"/>)"
      R"(<EventService><Event name="E" id="1" severity="low" safety="yes"/></EventService><TestService/>)"
      R"(<FunctionService><Function name="F" essential="yes" confirm="yes"/></FunctionService>)"
      R"(<HKService id="9" interval="10" enabled="no"><SampledOnce><ParamRef name="Q"/></SampledOnce></HKService>)",
      R"( budget_us="900" overruns="9" power_W="3")");
  EXPECT_TRUE(testing::read_text(text).value)
      << testing::rendered(testing::read_text(text).problems, testing::text_source(text));
}

TEST(SupervisorsDescriptor, IsRefusedWithTheMissionThatNamesIt) {
  const std::string hanging = testing::changed("  <Configuration", R"(  <Hang realtime="9"/><Configuration)",
                                               file_system()(testing::data / "supervisor.xml").value());
  const auto reading = read_mission(testing::data / "mission.xml", testing::overlay({{"supervisor.xml", hanging}}));
  EXPECT_FALSE(reading.value);
  ASSERT_EQ(reading.problems.size(), 1U) << testing::rendered(reading.problems, file_system());
  EXPECT_EQ(reading.problems[0].code, "E0332");
  EXPECT_EQ(reading.problems[0].file.filename(), "supervisor.xml");
}

}  // namespace
}  // namespace hirosco::descriptor
