// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "hirosco/pus/st129_supervision/supervision.hpp"
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
  Flight flight{with_reread()};
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
  [[nodiscard]] const descriptor::Subsystem& in_the_member() {
    return flight.craft().subsystem("JOYSTICK")->descriptor();
  }
  static constexpr int joystick = 11;
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

}  // namespace
}  // namespace hirosco::testing
