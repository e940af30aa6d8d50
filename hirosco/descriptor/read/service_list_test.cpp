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

TEST(ServiceList, HasOfALoopInAConfigurationWhatThatSaysAndTheRestOfTheSubsystem) {
  const SubsystemDescriptor read =
      read_text(library_with("", R"(<ServiceLoop name="SLOW" period_us="5000" priority="0"/>)", "",
                             R"(<ServiceLoop name="SLOW" budget_us="400"/>)"))
          .value.value();
  const ServiceLoop& own = read.loop_in_force(0, nullptr);
  const ServiceLoop& open = read.loop_in_force(0, read.find_configuration("OPEN"));
  const ServiceLoop& closed = read.loop_in_force(0, read.find_configuration("CLOSED"));
  EXPECT_EQ(&own, read.service_loops.data());
  EXPECT_EQ(own.period, 20ms);
  EXPECT_EQ(open.period, 20ms);
  EXPECT_EQ(open.priority, 12);
  EXPECT_EQ(open.budget, 400us);
  EXPECT_EQ(closed.name, "SLOW");
  EXPECT_EQ(closed.period, 5ms);
  EXPECT_EQ(closed.priority, 0);
  EXPECT_EQ(closed.budget, 900us);
  EXPECT_EQ(closed.queue, 3U);
}

TEST(ServiceList, RefusesAPaceThatCannotBe) {
  const auto refused = [](const std::string& of_configuration, const std::string& code, const std::string& words,
                          const std::string& services = "") {
    expect_one_in_list(library_with(services, of_configuration), code, words);
  };
  refused(R"(<ServiceLoop name="@SLOWER" period_us="5000"/>)", "E0244", "no <ServiceLoop> has the name 'SLOWER'");
  refused(R"(<ServiceLoop name="@SLOWER" period_us="5000"/>)", "E0244", "did you mean 'SLOW'?");
  refused(R"(<ServiceLoop name="@BOOK" period_us="5000"/>)", "E0244", "service BOOK runs in 'SLOW': name that");
  refused(R"(<ServiceLoop name="@ST03" period_us="5000"/>)", "E0244", "service ST03 has no loop of its own");
  refused(R"(<ServiceLoop name="@ST03" period_us="5000"/>)", "E0244", "service ST03 runs in 'SLOW'",
          R"(<Service name="ST03" loop="SLOW"/>)");
  refused(R"(<ServiceLoop name="@ST05" period_us="5000"/>)", "E0243",
          "ST05 has no loop of its own: every event of every loop is told by the service loop");
  refused(R"(@<ServiceLoop name="SLOW"/>)", "E0244", "nothing of the loop 'SLOW' is otherwise here");
  refused(R"(<ServiceLoop name="SLOW" period_us="@999"/>)", "E0112", "999");
  refused(R"(<ServiceLoop name="SLOW" priority="@85"/>)", "E0112", "85");
  refused(R"(<ServiceLoop name="SLOW" period_us="5000" @queue="4"/>)", "E0103", "queue");
  refused(R"(<ServiceLoop name="SLOW" period_us="5000" budget_us="@5001"/>)", "E0227",
          "a step of 5001 us every 5000 us does not end before the next");
  refused(R"(<ServiceLoop name="LONG" period_us="@1999"/>)", "E0227", "that is the budget of its subsystem",
          R"(<ServiceLoop name="LONG" period_us="4000" budget_us="2000"/><Service name="ST03" loop="LONG"/>)");
  refused(R"(<ServiceLoop name="SLOW" priority="1"/>@<ServiceLoop name="SLOW" priority="2"/>)", "E0201", "SLOW");
}

/// Its loop goes as it says itself until its configuration is in force, and the cycle of another one does not end in time beside that.
TEST(ServiceList, RefusesAModeAroundWhichALoopTakesMoreThanInItsConfiguration) {
  const auto file = [](const char* name) { return file_system()(data / name).value(); };
  const auto flown_with = [&](const std::string& budget_us) {
    const std::string robot = R"(<Configuration name="COUPLED" id="2" priority="80" sampling_us="500")",
                      wheel = R"(<Configuration name="COUPLED" id="2" priority="80" sampling_us="500">)";
    return read_mission(
        data / "mission.xml",
        overlay({{"coronagraph.xml", changed(robot, robot + R"( budget_us="100")", file("coronagraph.xml"))},
                 {"flywheel.xml",
                  changed(wheel,
                          R"(<ServiceLoop name="SLOW" period_us="1000" priority="84" budget_us=")" + budget_us +
                              R"("/><Service name="ST03" loop="SLOW"/>)" + wheel +
                              R"(<ServiceLoop name="SLOW" period_us="100000" priority="1" budget_us="300"/>)",
                          file("flywheel.xml"))}}));
  };
  const auto fits = flown_with("400");
  EXPECT_TRUE(fits.value) << rendered(fits.problems, file_system());
  const auto much = flown_with("401");
  ASSERT_EQ(much.problems.size(), 1U) << rendered(much.problems, file_system());
  EXPECT_EQ(much.problems[0].code, "E0331");
  EXPECT_EQ(much.problems[0].message,
            "in mode 'telepresence', while not all that it commissions is configured, a cycle of CORONAGRAPH 'COUPLED' "
            "may not end within its 500 us");
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
