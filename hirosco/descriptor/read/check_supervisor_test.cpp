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
  expect_not_of_supervisor(
      own_text(R"(@<ServiceLoop name="SLOW" period_us="1000"/><Service name="ST03" loop="SLOW"/>)"), "<ServiceLoop>");
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

TEST(SupervisorsDescriptor, SpinsForNobody) {
  const auto reading = testing::read_text(own_text("", R"( priority="50" budget_us="10" spin_us="10")"));
  ASSERT_EQ(reading.problems.size(), 2U);
  EXPECT_EQ(reading.problems[1].message, "'spin_us' of <Configuration> is not built in for the supervisor");
}

TEST(SupervisorsDescriptor, HasPoolsAndQueuesOfItsOwn) {
  const std::string text = own_text(
      R"(<Resources warning_percent="80" waiting_answers="512" cycle_events_kB="64"><Pool block="64" count="4"/></Resources>)");
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
