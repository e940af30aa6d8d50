// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/testing.hpp"

/// Which services a subsystem offers and in which loops they run, as its descriptor says it.
namespace hirosco::descriptor {
namespace {

using namespace testing;

const std::string library_text = R"(<Subsystem name="LIBRARY" id="10">
  RESOURCES
  <CustomService name="BOOK" type="200"><Request name="READ" subtype="1"/></CustomService>
  <ServiceLoop name="SLOW" period_us="20000" priority="12" budget_us="900" queue="3"/>
  <Service name="BOOK" loop="SLOW"/>
  SERVICES
  <Configuration name="OPEN" id="1" sampling_us="1000">OPEN</Configuration>
  <Configuration name="CLOSED" id="2" sampling_us="1000">CLOSED</Configuration>
</Subsystem>)";

std::string library_with(const std::string& services, const std::string& closed = "", const std::string& resources = "",
                         const std::string& open = "") {
  std::string text = library_text;
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"RESOURCES", resources},
                                 {"SERVICES", services},
                                 {">OPEN<", ">" + open + "<"},
                                 {">CLOSED<", ">" + closed + "<"}})
    text.replace(text.find(from), from.size(), to);
  return text;
}

void expect_one_in_list(const std::string& text, const std::string& code, const std::string& words) {
  const Marked file = marked(text);
  const auto reading = read_text(file.text);
  ASSERT_EQ(reading.problems.size(), 1U) << rendered(reading.problems, text_source(file.text));
  EXPECT_EQ(reading.problems[0].code, code);
  EXPECT_NE(rendered(reading.problems, text_source(file.text)).find(words), std::string::npos)
      << rendered(reading.problems, text_source(file.text));
  EXPECT_EQ(reading.problems[0].at, file.at);
}

TEST(ServiceList, SaysWhichLoopAServiceHasWithItsPeriodPriorityBudgetAndQueue) {
  const SubsystemDescriptor read =
      read_text(library_with(R"(<Service name="ST03" loop="SLOW"/><Service name="ST20" loop="SLOW" offered="no"/>)"))
          .value.value();
  ASSERT_EQ(read.service_loops.size(), 1U);
  EXPECT_EQ(read.service_loops[0].period, 20ms);
  EXPECT_EQ(read.service_loops[0].priority, 12);
  EXPECT_EQ(read.service_loops[0].budget, 900us);
  EXPECT_EQ(read.service_loops[0].queue, 3U);
  EXPECT_EQ(read.loop_of(200), 0);
  EXPECT_EQ(read.loop_of(3), 0);
  EXPECT_EQ(read.loop_of(20), 0) << "for a configuration that offers it";
  EXPECT_EQ(read.loop_of(17), -1);
  EXPECT_NE(read.find_event("SERVICE_LOOP_HANGS"), nullptr);
  EXPECT_EQ(read_text(R"(<Subsystem name="A" id="10"/>)").value.value().find_event("SERVICE_LOOP_HANGS"), nullptr);
}

TEST(ServiceList, OffersWhatTheSubsystemSaysAndEachConfigurationOtherwise) {
  const SubsystemDescriptor read =
      read_text(library_with(
                    R"(<Service name="ST20" offered="no"/>)",
                    R"(<Service name="BOOK" offered="no"/><Service name="ST20"/><Service name="ST05" offered="no"/>)"))
          .value.value();
  const Configuration *open = read.find_configuration("OPEN"), *closed = read.find_configuration("CLOSED");
  EXPECT_TRUE(read.offers(200, nullptr));
  EXPECT_TRUE(read.offers(200, open));
  EXPECT_FALSE(read.offers(200, closed));
  EXPECT_FALSE(read.offers(20, nullptr));
  EXPECT_FALSE(read.offers(20, open));
  EXPECT_TRUE(read.offers(20, closed));
  EXPECT_TRUE(read.offers(5, open));
  EXPECT_FALSE(read.offers(5, closed));
  for (const int type : {8, 17, 128})
    for (const Configuration* each : {open, closed})
      EXPECT_TRUE(read.offers(static_cast<std::uint8_t>(type), each)) << type;
}

TEST(ServiceList, RefusesWhatCannotBeSo) {
  expect_one_in_list(library_with(R"(<Service name="@BOOKS"/>)"), "E0242", "the subsystem has no service 'BOOKS'");
  expect_one_in_list(library_with(R"(<Service name="ST08" offered="@no"/>)"), "E0243",
                     "ST08 is offered by every subsystem");
  expect_one_in_list(library_with("", R"(<Service name="ST17" offered="@no"/>)"), "E0243",
                     "ST17 is offered by every subsystem");
  expect_one_in_list(library_with(R"(<Service name="@ST17"/>)"), "E0243", "ST17 is offered by every subsystem");
  expect_one_in_list(library_with(R"(<Service name="@ST3"/>)"), "E0242", "the subsystem has no service 'ST3'");
  expect_one_in_list(library_with(R"(<Service name="ST03" loop="@SLOWER"/>)"), "E0244",
                     "no <ServiceLoop> has the name 'SLOWER'");
  expect_one_in_list(library_with(R"(@<ServiceLoop name="IDLE" period_us="1000"/>)"), "E0244",
                     "no service runs in the loop 'IDLE'");
  expect_one_in_list(library_with(R"(@<Service name="BOOK"/>)"), "E0201", "BOOK");
  expect_one_in_list(library_with("", R"(<Service name="BOOK" @loop="SLOW"/>)"), "E0103", "loop");
  expect_one_in_list(library_with("", R"(<Service name="ST03" offered="no"/>
    @<HKService id="9" interval="10"><SampledOnce><ParamRef name="CYCLE_STATS"/></SampledOnce></HKService>)"),
                     "E0245", "does not offer ST03");
  expect_one_in_list(library_with("", "", R"(@<Resources threads="2"/>)"), "E0248", "2 threads are less than its 3");
  expect_one_in_list(
      library_with(
          R"(<ServiceLoop name="LONG" period_us="1000" budget_us="@1001"/><Service name="ST03" loop="LONG"/>)"),
      "E0227", "does not end before the next");
}

TEST(ServiceList, SaysOfEachServiceOfTheFrameworkThatHasNoLoopOfItsOwnWhy) {
  for (const auto& [name, because] : {std::pair{"ST01", "nobody asks it anything"},
                                      {"ST05", "every event of every loop is told by the service loop"},
                                      {"ST08", "states and calls reach the cycle in their order"},
                                      {"ST17", "its answer says that the service loop lives"},
                                      {"ST128", "the cycle is given its links"},
                                      {"ST129", "the supervisor alone answers it"},
                                      {"ST130", "it changes what all loops read"},
                                      {"ST30", "it is made for the service loop"}}) {
    SCOPED_TRACE(name);
    const std::string service = std::string{R"(<Service name=")"} + name + R"(" loop="@SLOW"/>)";
    expect_one_in_list(library_with(service), "E0243", std::string{name} + " has no loop of its own: " + because);
    expect_one_in_list(library_with(service), "E0243", "ST03, ST20 and services of its own may have one");
  }
  for (const StandardService& each : standard_services_by_name) {
    const auto why = std::ranges::find(stays_in_service_loop, each.name, &StaysInServiceLoop::name);
    EXPECT_NE(each.may_have_loop, why != stays_in_service_loop.end()) << each.name;
  }
}

/// So a service that comes to the framework needs no row beside its folder's.
TEST(ServiceList, OfWhichServicesOfTheFrameworkADescriptorHasNothingToSayTheReaderNeedNotKnow) {
  for (const char* name : {"ST08", "ST17", "ST30", "ST128", "ST130"})
    EXPECT_TRUE(is_standard_service_name(name)) << name;
  for (const char* name : {"ST", "ST3", "ST003", "ST1280", "ST0X", "BOOK"})
    EXPECT_FALSE(is_standard_service_name(name)) << name;
  expect_one_in_list(library_with(R"(<Service name="ST30" offered="@no"/>)"), "E0243",
                     "ST30 is offered by every subsystem or by none");
}

}  // namespace
}  // namespace hirosco::descriptor
