// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {

using testing::changed;
using testing::data;
using testing::overlay;
using testing::rendered;

/// The example's mission with these attributes on link 1, both ends of which have udp.
Reading<Mission> with_way(const std::string& attributes, const std::string& of_link_2 = {}) {
  const auto file = [](const char* name) { return file_system()(data / name).value(); };
  const std::string both = "methods=\"shared_memory udp\"";
  const std::string first = changed("to=\"FLYWHEEL.PLATE_STATE\"", "to=\"FLYWHEEL.PLATE_STATE\" " + attributes);
  return read_mission(
      data / "mission.xml",
      overlay({{"mission.xml",
                changed("to=\"CORONAGRAPH.FLYWHEEL_STATE\"", "to=\"CORONAGRAPH.FLYWHEEL_STATE\" " + of_link_2, first)},
               {"coronagraph.xml", changed("methods=\"shared_memory\"", both, file("coronagraph.xml"))},
               {"flywheel.xml", changed("name=\"PLATE_STATE\" from", "name=\"PLATE_STATE\" " + both + " from",
                                        file("flywheel.xml"))}}));
}

TEST(LinkWay, IsOfTheMissionWhoKnowsItsNetwork) {
  const auto plain = with_way("");
  ASSERT_TRUE(plain.value) << rendered(plain.problems, file_system());
  EXPECT_FALSE(plain.value->find_link(1)->method);
  for (const auto& [from, to] : {std::pair{"192.0.2.1", "192.0.2.2:4000"},
                                 {"[2001:db8::1]:7", "2001:db8::2"},
                                 {"127.0.0.1:5000", "127.0.0.2"},
                                 {"::1", "::1"}}) {
    const auto reading =
        with_way(std::string{"method=\"udp\" from_address=\""} + from + "\" to_address=\"" + to + "\"");
    ASSERT_TRUE(reading.value) << from << rendered(reading.problems, file_system());
    EXPECT_EQ(reading.value->find_link(1)->method, LinkMethod::Udp);
    EXPECT_EQ(reading.value->find_link(1)->from_address, from);
    EXPECT_EQ(reading.value->find_link(1)->to_address, to);
  }
  EXPECT_TRUE(with_way(R"(method="udp")").value);
  EXPECT_TRUE(with_way(R"(method="udp" to_address="127.0.0.1:4000")").value);
  EXPECT_TRUE(with_way(R"(method="shared_memory")").value);
}

TEST(LinkWay, IsRefusedWhereItLeadsNowhere) {
  struct WrongWay {
    const char* attributes;
    const char* code;
    const char* at;  ///< what stands where the problem is shown
  };
  for (const WrongWay& bad :
       {WrongWay{R"(method="upd")", "E0113", "upd"},
        {R"(method="tipc")", "E0224", "tipc"},
        {R"(from_address="127.0.0.1")", "E0343", "127.0.0.1"},
        {R"(method="shared_memory" to_address="127.0.0.1")", "E0343", "127.0.0.1"},
        {R"(method="udp" from_address="localhost")", "E0217", "localhost"},
        {R"(method="udp" to_address="127.0.0.1:0")", "E0217", "127.0.0.1:0"},
        {R"(method="udp" to_address="224.0.0.1")", "E0217", "224.0.0.1"},
        {R"(method="udp" from_address="192.0.2.1")", "E0344", "192.0.2.1"},
        {R"(method="udp" to_address="::1")", "E0344", "::1"},
        {R"(method="udp" from_address="192.0.2.1" to_address="127.0.0.1")", "E0344", "192.0.2.1"}}) {
    const auto reading = with_way(bad.attributes);
    EXPECT_FALSE(reading.value) << bad.attributes;
    ASSERT_EQ(reading.problems.size(), 1U) << bad.attributes << rendered(reading.problems, file_system());
    EXPECT_EQ(reading.problems[0].code, bad.code) << bad.attributes;
    const std::string text =
        changed("to=\"FLYWHEEL.PLATE_STATE\"", "to=\"FLYWHEEL.PLATE_STATE\" " + std::string{bad.attributes});
    const std::size_t line = text.find("<Link id=\"1\"");
    const std::size_t start = text.rfind('\n', line) + 1;
    EXPECT_EQ(reading.problems[0].at.line, 23) << bad.attributes;
    EXPECT_EQ(static_cast<std::size_t>(reading.problems[0].at.column), text.find(bad.at, line) - start + 1)
        << bad.attributes;
  }
}

TEST(LinkWay, HasAMethodThatBothEndsHave) {
  const auto reading = with_way("", R"(method="udp")");
  ASSERT_FALSE(reading.value);
  ASSERT_FALSE(reading.problems.empty());
  EXPECT_EQ(reading.problems[0].code, "E0308");
  EXPECT_NE(reading.problems[0].message.find("not both ends have method 'udp'"), std::string::npos);
}

/// The example's mission with these terms of PLATE_STATE where it is given and where it is taken.
Reading<Mission> with_terms(const std::string& given, const std::string& taken,
                            const std::string& cycle = R"(sampling_us="500")") {
  const std::string robot = file_system()(data / "coronagraph.xml").value();
  const std::string wheel =
      changed(R"(name="COUPLED" id="2" priority="80" sampling_us="500")",
              R"(name="COUPLED" id="2" priority="80" )" + cycle, file_system()(data / "flywheel.xml").value());
  return read_mission(data / "mission.xml",
                      overlay({{"coronagraph.xml",
                                changed(R"(methods="shared_memory" byte_order="native" kind="latest")", given, robot)},
                               {"flywheel.xml", changed(R"(name="PLATE_STATE" from)",
                                                        R"(name="PLATE_STATE" )" + taken + " from", wheel)}}));
}

TEST(LinkWay, IsOneThatCarriesMethodAndKindTogether) {
  EXPECT_TRUE(with_terms(R"(methods="udp shared_memory" kind="latest queued")", R"(kind="queued")").value);
  EXPECT_TRUE(with_terms(R"(methods="udp shared_memory" kind="queued latest")", R"(methods="udp")").value);
  const auto deaf = with_terms(R"(methods="udp" byte_order="little")", R"(methods="shared_memory udp")",
                               R"(sampling_us="500" started_by="PLATE_STATE" least_us="250")");
  EXPECT_FALSE(deaf.value);
  ASSERT_FALSE(deaf.problems.empty());
  EXPECT_EQ(deaf.problems[0].code, "E0308");
  EXPECT_EQ(deaf.problems[0].message,
            "link 1 does not fit: nothing wakes a cycle between 'CORONAGRAPH.PLATE_STATE' (methods \"udp\", kind "
            "\"latest\") and 'FLYWHEEL.PLATE_STATE' (methods \"shared_memory udp\", kind \"latest\")");
}

TEST(LinkWay, NeedsPeriodsOfWhichOneIsAMultipleOfTheOther) {
  for (const char* fitting : {"1000", "250", "5000"}) {
    const auto reading = with_terms("", "", std::string{"sampling_us=\""} + fitting + "\"");
    EXPECT_TRUE(reading.value) << fitting << rendered(reading.problems, file_system());
  }
  const auto reading = with_terms("", "", R"(sampling_us="750")");
  EXPECT_FALSE(reading.value);
  ASSERT_FALSE(reading.problems.empty());
  EXPECT_EQ(reading.problems[0].code, "E0308");
  EXPECT_EQ(
      reading.problems[0].message,
      "link 1 does not fit: one period has to be a multiple of the other, of 'CORONAGRAPH.PLATE_STATE' (500 us in "
      "'COUPLED') and 'FLYWHEEL.PLATE_STATE' (750 us in 'COUPLED')");
  // Who waits for samples has their rate; what it gives itself comes at its own.
  const auto started = with_terms("", "", R"(sampling_us="750" started_by="PLATE_STATE" least_us="250")");
  ASSERT_FALSE(started.problems.empty());
  for (const Diagnostic& problem : started.problems)
    EXPECT_EQ(problem.message.find("link 1 "), std::string::npos) << problem.message;
}

TEST(LinkWay, TakesNoAddressTwice) {
  const auto file = R"(method="udp" from_address="127.0.0.1:4000" to_address="127.0.0.1:4000")";
  const auto reading = with_way(file);
  ASSERT_EQ(reading.problems.size(), 1U) << rendered(reading.problems, file_system());
  EXPECT_EQ(reading.problems[0].code, "E0313");
}

}  // namespace
}  // namespace hirosco::descriptor
