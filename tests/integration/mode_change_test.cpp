// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/utilities/testing/slice.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "simulation/world/random.hpp"
#include "tests/integration/flight.hpp"

/// SET_MODE brings the whole craft from one mode into another (docs/adr/0075): rokviss, with its links and its devices.
namespace hirosco::testing {
namespace {

using pus::FailureCode;
using simulation::CommandOutcome;

struct ModeChange : ::testing::Test {
  Flight flight{{.edit = simulation::hand_rests}};

  void SetUp() override { ASSERT_TRUE(flight.commission()) << flight.story().text(); }

  /// Everybody of it is where it wants them, and moves what is to be moved.
  [[nodiscard]] std::string missing(std::string_view mode) {
    if (flight.craft().supervisor().mode().name != mode) return "the mode";
    for (const auto& step : flight.mission().find_mode(mode)->commission) {
      const auto& subsystem = flight.mission().find_subsystem(step.subsystem)->subsystem;
      if (flight.state(step.subsystem) != step.state) return step.subsystem;
      const auto in_force = flight.craft().vital(step.subsystem)->configuration.load(std::memory_order_relaxed);
      if (in_force != subsystem.find_configuration(step.configuration)->id) return step.subsystem + "'s configuration";
      if (flight.inhibited(step.subsystem) != 0) return step.subsystem + " is inhibited";
    }
    for (const std::uint8_t link : flight.mission().find_mode(mode)->establish)
      if (!flight.craft().supervisor().links().is_up(link)) return "link " + std::to_string(link);
    return {};
  }
  [[nodiscard]] bool may_move(const char* name) {
    const auto* page = flight.craft().permit(name);
    return page != nullptr && page->permits(page->epoch.load());
  }
};

TEST_F(ModeChange, AllModesFollowOneAnotherByOneTelecommandEachInTheSameProcesses) {
  const auto epochs = [&] {
    std::vector<const GenericSubsystem*> all;
    for (const char* name : {"MANIPULATOR", "JOYSTICK", "COMMUNICATION"}) all.push_back(flight.craft().subsystem(name));
    return all;
  };
  const auto before = epochs();
  for (const char* mode : {"feel", "remote", "automatic", "standalone", "remote", "standalone", "telepresence"}) {
    const CommandOutcome outcome = flight.set_mode(mode);
    ASSERT_TRUE(outcome.completed) << mode << "\n" << flight.story().text();
    EXPECT_GT(outcome.progress_reports, 2) << mode << ": each stage is told";
    flight.craft().run(200ms);
    EXPECT_EQ(missing(mode), "") << mode;
  }
  EXPECT_EQ(epochs(), before);
}

TEST_F(ModeChange, WhoIsNotOfTheNewModeIsOffline) {
  ASSERT_TRUE(flight.set_mode("automatic").completed);
  EXPECT_EQ(flight.state("JOYSTICK"), State::Offline);
  EXPECT_EQ(flight.craft().supervisor().links().up_count(), 0U);
}

TEST_F(ModeChange, TheModeThatHoldsBringsUpWhatHasFallenTenTimesInARow) {
  for (int time = 1; time <= 10; ++time) {
    ASSERT_TRUE(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}).completed) << time;
    flight.craft().run(100ms);
    EXPECT_FALSE(may_move("MANIPULATOR")) << time;
    ASSERT_TRUE(flight.set_mode("telepresence").completed) << time << "\n" << flight.story().text();
    flight.craft().run(100ms);
    EXPECT_EQ(missing("telepresence"), "") << time;
  }
}

TEST_F(ModeChange, WhileItIsUnderWayNobodyElseMovesAnythingAndEverybodyMayStopIt) {
  flight.story().on_line = [&](std::string_view line) {
    if (!line.starts_with("change from mode")) return;
    const auto move = function_packet(10, 4711, call_data("HOLD", {}));
    flight.craft().ground().send(move);
  };
  std::vector<std::uint16_t> refused;
  flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
    if (report.service() != 1 || report.subtype() != 2) return;
    OctetReader reader{report.source_data()};
    static_cast<void>(reader.get<std::uint32_t>());
    refused.push_back(reader.get<std::uint16_t>());
  };
  ASSERT_TRUE(flight.set_mode("standalone").completed);
  EXPECT_EQ(refused, std::vector{static_cast<std::uint16_t>(FailureCode::NotPermittedNow)});
  EXPECT_EQ(missing("standalone"), "");
}

TEST_F(ModeChange, AnImpossibleOneMovesNobodyAndTheReasonsAreTelemetry) {
  flight.craft().kill("JOYSTICK");
  flight.craft().run(20ms);
  const auto before = flight.state("COMMUNICATION");
  std::vector<std::byte> preview;
  flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
    if (report.service() == 129 && report.subtype() == pus::st129::mode_preview)
      preview.assign(report.source_data().begin(), report.source_data().end());
  };
  EXPECT_EQ(flight.set_mode("standalone").failure, FailureCode::WrongStatus);
  EXPECT_EQ(flight.state("COMMUNICATION"), before);
  ASSERT_GT(preview.size(), 2U);
  EXPECT_GE(std::to_integer<int>(preview[1]), 1) << "reasons";
}

/// Whatever happens at whatever moment of a change: the craft is in the old mode, in the new one, or in its initial mode with
/// nothing that may move; and the next change flies again.
TEST(ModeChanges, EndInTheOldModeTheNewOneOrSafeWhateverHappensAtAnyMoment) {
  simulation::Random random{20'261'123};
  std::map<std::string, int> ends;
  for (int round = 0; round < 60 / one_in(3); ++round) {
    Flight flight{{.edit = simulation::hand_rests}};
    ASSERT_TRUE(flight.commission());
    const char* const to = std::array{"standalone", "remote", "automatic", "feel"}[static_cast<std::size_t>(round) % 4];
    const auto disturb_after = Duration{static_cast<std::int64_t>(random.uniform(0, 120e6))};
    // One argument, the first, of one octet.
    auto asked = call_data("SET_MODE", {});
    asked.back() = std::byte{1};
    asked.insert(asked.end(), {std::byte{1}, std::byte{flight.mission().find_mode(to)->id}});
    flight.craft().ground().send(function_packet(1, 3000, asked));
    flight.craft().run(disturb_after);
    const int what = round % 5;
    const char* const whom = random.uniform(0, 1) < 0.5 ? "MANIPULATOR" : "JOYSTICK";
    if (what == 0) flight.craft().kill(whom);
    if (what == 1) flight.craft().stop(whom, true);
    if (what == 2) static_cast<void>(flight.craft().command("SUPERVISOR", "SAFE_ALL", {}));
    if (what == 3) flight.craft().stick(whom, true);
    if (what == 4) flight.craft().spin(whom);
    flight.craft().run(4s);
    if (what == 3) flight.craft().stick(whom, false);
    if (what == 1) flight.craft().stop(whom, false);
    if (what == 4) flight.craft().call_spin_off(whom);  // who is Offline has no cycle that could
    flight.craft().run(6s);
    const std::string now = flight.craft().supervisor().mode().name;
    const bool known = now == "telepresence" || now == to || now == flight.mission().initial_mode;
    EXPECT_TRUE(known) << now;
    ++ends[now == to ? "new" : now == "telepresence" ? "old" : "safe"];
    if (now == flight.mission().initial_mode)
      for (const char* name : {"MANIPULATOR", "JOYSTICK"}) {
        const auto* page = flight.craft().permit(name);
        EXPECT_TRUE(page == nullptr || !page->permits(page->epoch.load())) << round << ", " << name << "\n"
                                                                           << flight.story().text();
      }
    // And again.
    for (const char* name : {"MANIPULATOR", "JOYSTICK"})
      if (!flight.craft().alive(name)) static_cast<void>(flight.set_state(name, State::Offline));
    flight.craft().run(500ms);
    EXPECT_TRUE(flight.set_mode("telepresence").completed) << round << " " << what << " " << to << "\n"
                                                           << flight.story().text();
    flight.craft().run(200ms);
    EXPECT_EQ(flight.inhibited("MANIPULATOR"), 0U) << round;
    EXPECT_EQ(flight.state("JOYSTICK"), State::Operational) << round;
  }
  EXPECT_GT(ends["safe"], 5);
  EXPECT_GT(ends["new"] + ends["old"], 5);
}

}  // namespace
}  // namespace hirosco::testing
