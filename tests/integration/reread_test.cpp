// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "tests/integration/flight.hpp"

/// Descriptors of rokviss that are edited while they fly (docs/adr/0095).
namespace hirosco::testing {
namespace {

using ::testing::HasSubstr;

[[nodiscard]] std::string text_of(const std::string& file) {
  std::ifstream stream{std::filesystem::path{HIROSCO_SOURCE_DIR} / file};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

[[nodiscard]] std::string changed(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The modes of rokviss permit nobody REREAD.
[[nodiscard]] Plan with_reread() {
  return {.edit = [](descriptor::Mission& mission) {
    hand_rests(mission);
    for (auto& mode : mission.modes)
      mode.permits.push_back(
          {.subsystem = "SUPERVISOR", .functions = {"REREAD"}, .services = {}, .parameters = {}, .at = {}});
  }};
}

struct Reread : ::testing::Test {
  explicit Reread(Plan plan = with_reread()) : flight{std::move(plan)} {}
  Flight flight;
  const std::string shipped = text_of("subsystems/joystick/joystick.xml");
  std::vector<pus::st129::DescriptorProblem> problems;

  void SetUp() override {
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) {
      if (report.service() != 129 || report.subtype() != pus::st129::descriptor_problem) return;
      if (auto problem = pus::st129::read_descriptor_problem(report.source_data())) problems.push_back(*problem);
    };
    ASSERT_TRUE(flight.commission()) << flight.story().text();
  }
  /// Offline, with its links given back.
  [[nodiscard]] bool comes_to_rest() {
    return flight.set_state("JOYSTICK", State::SafeOperational).completed &&
           flight.set_state("JOYSTICK", State::Offline).completed;
  }
  [[nodiscard]] bool reread() { return flight.craft().command("SUPERVISOR", "REREAD", {Number{joystick}}).completed; }
  [[nodiscard]] const descriptor::SubsystemDescriptor& in_the_member() {
    return flight.craft().subsystem("JOYSTICK")->descriptor();
  }
  /// The descriptor in force when it is read, with another place of the device in its first configuration.
  [[nodiscard]] std::string with_device_at(const std::string& address) const {
    return changed(shipped, endnode, "transfer=\"udp\" address=\"" + address + "\"");
  }
  [[nodiscard]] std::string address_in_the_member() {
    return in_the_member().configurations.front().devices.front().endnode.address;
  }
  /// Told by file, line, column, number and words as `hirosco check` and the start tell it.
  void is_refused_as_at_the_start(const std::string& text, const std::string& address) {
    problems.clear();
    flight.write("joystick.xml", text);
    EXPECT_FALSE(reread()) << flight.story().text();
    const auto at_the_start =
        descriptor::read_mission(flight.mission().file, [&](const std::filesystem::path& file) -> Result<std::string> {
          if (file.filename() == "joystick.xml") return text;
          return *flight.mission().texts.at(file);
        });
    ASSERT_EQ(at_the_start.problems.size(), 1U);
    const descriptor::Diagnostic& wanted = at_the_start.problems.front();
    EXPECT_EQ(wanted.code, "E0313");
    EXPECT_EQ(wanted.message, "'" + address + "' leaves this computer");
    ASSERT_EQ(problems.size(), 1U) << flight.story().text();
    const pus::st129::DescriptorProblem& told = problems.front();
    EXPECT_EQ(told.code, wanted.code);
    EXPECT_EQ(told.what, wanted.message);
    EXPECT_EQ(told.hint, wanted.hint);
    EXPECT_EQ(told.file, wanted.file.string());
    EXPECT_EQ(told.line, wanted.at.line);
    EXPECT_EQ(told.column, wanted.at.column);
  }
  static constexpr int joystick = 11;
  static constexpr auto endnode = R"(transfer="shared_memory" address="joystick-handle")";
};

/// The mission lets devices be in one network besides this computer (docs/adr/0112).
struct RereadInANetwork : Reread {
  RereadInANetwork() : Reread{plan()} {}
  static Plan plan() {
    Plan plan = with_reread();
    plan.files["mission.xml"] = changed(text_of("missions/rokviss/mission.xml"), "<Supervisor ",
                                        "<DeviceNetwork address=\"192.0.2.0/24\"/>\n  <Supervisor ");
    return plan;
  }
};

TEST_F(Reread, HousekeepingOfWhoIsOfflineChangesWithTheSameProcess) {
  const auto* const process = flight.craft().subsystem("JOYSTICK");
  const std::uint32_t interval = in_the_member().configurations.front().housekeeping.front().interval_cycles;
  const std::string was = "interval=\"" + std::to_string(interval) + "\"";
  flight.write("joystick.xml", changed(shipped, was, "interval=\"" + std::to_string(2 * interval) + "\""));
  EXPECT_FALSE(reread()) << "it is not at rest";
  ASSERT_TRUE(comes_to_rest()) << flight.story().text();
  ASSERT_TRUE(reread()) << flight.story().text();
  EXPECT_EQ(flight.craft().subsystem("JOYSTICK"), process);
  EXPECT_EQ(in_the_member().configurations.front().housekeeping.front().interval_cycles, 2 * interval);
  EXPECT_TRUE(flight.story().has("JOYSTICK flies by "));
}

TEST_F(Reread, ABadEditIsToldByPlaceAndWhoDiesThenComesBackByWhatIsInForce) {
  ASSERT_TRUE(comes_to_rest()) << flight.story().text();
  const std::string bad = changed(shipped, "interval=\"", "interval=\"x");
  flight.write("joystick.xml", bad);
  EXPECT_FALSE(reread());
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.front().apid, joystick);
  EXPECT_THAT(problems.front().file, HasSubstr("joystick.xml"));
  const auto line =
      1 + std::count(bad.begin(), bad.begin() + static_cast<std::ptrdiff_t>(bad.find("interval=\"x")), '\n');
  EXPECT_EQ(problems.front().line, line);
  flight.craft().kill("JOYSTICK");
  ASSERT_TRUE(flight.craft().run_until([&] { return flight.craft().alive("JOYSTICK"); }, 10s)) << flight.story().text();
  EXPECT_TRUE(flight.run_until_state("JOYSTICK", State::Offline, 1s));
}

TEST_F(Reread, WhoNeedsWhatIsGoneIsNamedByItsFile) {
  ASSERT_TRUE(comes_to_rest()) << flight.story().text();
  const auto& provided = in_the_member().configurations;
  std::string set;
  for (const auto& configuration : provided)
    if (!configuration.provides.empty()) set = configuration.provides.front().name;
  ASSERT_FALSE(set.empty());
  flight.write("joystick.xml", changed(shipped, "<Provides name=\"" + set + "\"", "<Provides name=\"OTHERWISE\""));
  EXPECT_FALSE(reread());
  ASSERT_FALSE(problems.empty());
  EXPECT_THAT(problems.front().file, HasSubstr("mission.xml"));
  EXPECT_THAT(problems.front().what, HasSubstr(set));
}

TEST_F(Reread, ADeviceBeyondThisComputerIsRefusedAsAtTheStart) {
  ASSERT_TRUE(comes_to_rest()) << flight.story().text();
  is_refused_as_at_the_start(with_device_at("192.0.2.7:5001"), "192.0.2.7:5001");
  EXPECT_EQ(address_in_the_member(), "joystick-handle");
  // What was in force is, for who is started anew as well.
  EXPECT_TRUE(flight.set_mode("standalone").completed) << flight.story().text();
  EXPECT_EQ(flight.state("JOYSTICK"), State::Operational);
}

TEST_F(RereadInANetwork, ADeviceInItIsTakenAndOneOutsideIsNot) {
  ASSERT_TRUE(comes_to_rest()) << flight.story().text();
  flight.write("joystick.xml", with_device_at("192.0.2.7:5001"));
  ASSERT_TRUE(reread()) << flight.story().text();
  EXPECT_EQ(address_in_the_member(), "192.0.2.7:5001");
  is_refused_as_at_the_start(with_device_at("192.0.3.7:5001"), "192.0.3.7:5001");
  EXPECT_EQ(address_in_the_member(), "192.0.2.7:5001") << "it keeps the one before";
  flight.craft().kill("JOYSTICK");
  ASSERT_TRUE(flight.craft().run_until([&] { return flight.craft().alive("JOYSTICK"); }, 10s)) << flight.story().text();
  EXPECT_EQ(address_in_the_member(), "192.0.2.7:5001") << "and begins with it";
}

TEST_F(RereadInANetwork, WhatItPermitsIsWhatTheMissionSaidWhenItWasJudged) {
  ASSERT_TRUE(comes_to_rest()) << flight.story().text();
  flight.write("mission.xml", changed(text_of("missions/rokviss/mission.xml"), "<Supervisor ",
                                      "<DeviceNetwork address=\"192.0.3.0/24\"/>\n  <Supervisor "));
  is_refused_as_at_the_start(with_device_at("192.0.3.7:5001"), "192.0.3.7:5001");
  EXPECT_EQ(address_in_the_member(), "joystick-handle");
}

}  // namespace
}  // namespace hirosco::testing
