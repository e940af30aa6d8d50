// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/unprovoked_reactions.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace hirosco::supervisor {
namespace {

struct Nobody final : Observer {
  void told(OnboardTime, std::string_view) override {}
  void routed(const pus::TelemetryView&) override {}
};

class ReactionCauses : public ::testing::Test {
 protected:
  ReactionCauses() { clock.advance(std::chrono::hours{1}); }
  void tell(std::string_view line) { causes.told(clock.onboard(), line); }

  ManualClock clock;
  Nobody nobody;
  UnprovokedReactions causes{clock, nobody};
};

TEST_F(ReactionCauses, AreMissedOfANetworkThatGoesDownAndOfAnEventOfHighSeverityOnly) {
  tell("ARM medium TORQUE_LIMIT_EXCEEDED");
  tell("plan limit: ARM to Safe-Operational because of TORQUE_LIMIT_EXCEEDED");
  EXPECT_TRUE(causes.uncommanded().empty());
  tell("ARM high SENSOR_BROKEN");
  tell("plan broken: ARM to Post-Operational because of SENSOR_BROKEN");
  EXPECT_EQ(causes.uncommanded().size(), 1U);
  tell("plan died: network {ARM, HAND}");
  EXPECT_EQ(causes.uncommanded().size(), 2U);
}

TEST_F(ReactionCauses, AreFoundInAStopBySomebodyForAsLongAsThatMayHaveEffects) {
  tell("stop by signal or local socket: every actuator inhibited");
  clock.advance(UnprovokedReactions::limit);
  tell("plan died: network {ARM, HAND}");
  EXPECT_TRUE(causes.uncommanded().empty());
  clock.advance(std::chrono::milliseconds{1});
  tell("plan died: network {ARM, HAND}");
  EXPECT_EQ(causes.uncommanded().size(), 1U);
}

TEST_F(ReactionCauses, NameTheEventThatTheReactionAnswers) {
  tell("ARM high ARM_LOST REASON=silent");
  tell("plan down: network {ARM}");
  tell("HAND died: signal 9");
  tell("plan died: network {HAND}");
  tell("HAND hangs: its cycle stands still");
  tell("plan down: network {HAND}");
  ASSERT_EQ(causes.uncommanded().size(), 3U);
  EXPECT_EQ(causes.uncommanded()[0].subsystem, "ARM");
  EXPECT_EQ(causes.uncommanded()[0].event, "ARM_LOST");
  EXPECT_EQ(causes.uncommanded()[1].event, "PROCESS_DIED");
  EXPECT_EQ(causes.uncommanded()[2].event, "HANG");
}

/// A supervisor dies at every step of this flight, and whoever goes on knows what was missed, and what may still be an effect.
TEST_F(ReactionCauses, AreKnownOfTheWholeFlightHoweverManySupervisorsDie) {
  for (int dies_before = 0; dies_before <= 4; ++dies_before) {
    std::vector<std::byte> memory(1 << 16);
    const auto flight = std::make_unique<UnprovokedReactions>(clock, nobody);
    UnprovokedReactions next{clock, nobody};
    int step = 0;
    const auto hearing = [&]() -> Observer& {
      if (step++ == dies_before) {
        Journal before{memory};
        EXPECT_TRUE((Memory{&before, {flight.get()}}.note()));
        Journal after{memory};
        EXPECT_TRUE((Memory{&after, {&next}}.recall()));
      }
      if (step > dies_before) return next;
      return *flight;
    };
    const TimePoint begin = clock.now();
    hearing().told(clock.onboard(), "HAND died: signal 9");
    hearing().told(clock.onboard(), "plan died: network {HAND}");
    clock.advance(std::chrono::hours{1});
    hearing().told(clock.onboard(), "stop by signal or local socket: every actuator inhibited");
    clock.advance(UnprovokedReactions::limit);
    hearing().told(clock.onboard(), "plan died: network {ARM}");
    static_cast<void>(hearing());
    ASSERT_EQ(next.uncommanded().size(), 1U) << dies_before;
    EXPECT_EQ(next.uncommanded()[0].at, begin);
    if (dies_before == 1) continue;  // between the two lines of one step, which a note does not part
    EXPECT_EQ(next.uncommanded()[0].subsystem, "HAND");
    EXPECT_EQ(next.uncommanded()[0].event, "PROCESS_DIED");
  }
}

TEST_F(ReactionCauses, HaveRoomInTheNotesWithTheLongestOfNames) {
  for (int time = 0; time < 200; ++time) {
    tell(std::string(300, 'A') + " high " + std::string(300, 'B'));
    tell("plan down: network {ARM}");
  }
  std::vector<std::byte> memory(1 << 18);
  Journal journal{memory};
  ASSERT_TRUE((Memory{&journal, {&causes}}.note()));
  UnprovokedReactions next{clock, nobody};
  ASSERT_TRUE((Memory{&journal, {&next}}.recall()));
  EXPECT_EQ(next.uncommanded().size(), causes.uncommanded().size());
}

class InjectionAsCause : public ::testing::Test {
 protected:
  InjectionAsCause() {
    play("motor", "ARM", "ARM-BUS");
    play("stick", "HAND", "HAND");
  }
  void play(const char* name, const char* subsystem, const char* device) {
    descriptor::SimulatedDevice& played = mission.devices.emplace_back();
    played.name = name;
    played.subsystem = subsystem;
    played.device = device;
  }
  [[nodiscard]] static TimePoint at(double second) {
    return TimePoint{std::chrono::duration_cast<Duration>(std::chrono::duration<double>(second))};
  }
  void inject(double second, const char* device, const char* line) { injections.push_back({at(second), device, line}); }
  [[nodiscard]] bool caused(double second, const char* subsystem, const char* event) const {
    return unprovoked({{at(second), subsystem, event}}, injections, mission).empty();
  }
  descriptor::Mission mission;
  std::vector<DeviceInjection> injections;
};

TEST_F(InjectionAsCause, IsWhatWasInjectedUpToTwoSecondsBefore) {
  inject(10, "motor", "corrupt 5");
  EXPECT_FALSE(caused(9.9, "ARM", "HOT"));
  EXPECT_TRUE(caused(12, "ARM", "HOT"));
  EXPECT_TRUE(caused(12, "ARM", "PROCESS_DIED"));
  EXPECT_FALSE(caused(12.1, "ARM", "HOT"));
}

TEST_F(InjectionAsCause, IsAnUnplugOfTheLossOfThatDeviceUntilItIsPluggedIn) {
  inject(10, "motor", "unplug");
  EXPECT_TRUE(caused(500, "ARM", "ARM_BUS_LOST"));
  EXPECT_FALSE(caused(500, "HAND", "HAND_LOST")) << "another device";
  EXPECT_FALSE(caused(500, "ARM", "ARM_LOST")) << "another device of the same subsystem";
  EXPECT_FALSE(caused(500, "ARM", "HOT"));
  EXPECT_FALSE(caused(500, "ARM", "PROCESS_DIED"));
  inject(600, "motor", "heal");
  EXPECT_TRUE(caused(700, "ARM", "ARM_BUS_LOST")) << "that plugs nothing in";
  inject(800, "motor", "plug");
  EXPECT_TRUE(caused(802, "ARM", "ARM_BUS_LOST"));
  EXPECT_FALSE(caused(802.1, "ARM", "ARM_BUS_LOST"));
  EXPECT_TRUE(caused(500, "ARM", "ARM_BUS_LOST")) << "what comes after has caused nothing before";
}

TEST_F(InjectionAsCause, IsSilenceUntilItIsHealedAndAStallForItsTime) {
  inject(10, "stick", "silent");
  EXPECT_TRUE(caused(100, "HAND", "HAND_LOST"));
  inject(200, "stick", "heal");
  EXPECT_FALSE(caused(300, "HAND", "HAND_LOST"));
  inject(400, "stick", "stall 30000");
  EXPECT_TRUE(caused(431, "HAND", "HAND_LOST"));
  EXPECT_FALSE(caused(433, "HAND", "HAND_LOST"));
  inject(500, "stick", "delay 20");
  EXPECT_TRUE(caused(600, "HAND", "HAND_LOST"));
  inject(700, "stick", "delay 0");
  EXPECT_FALSE(caused(800, "HAND", "HAND_LOST"));
}

TEST_F(InjectionAsCause, IsNoHealAndNoPlugOfADeath) {
  inject(10, "motor", "heal");
  inject(10, "stick", "plug");
  EXPECT_FALSE(caused(10.5, "ARM", "PROCESS_DIED"));
  EXPECT_FALSE(caused(10.5, "HAND", "HANG"));
  EXPECT_TRUE(caused(10.5, "ARM", "HOT")) << "a value that jumps back may trip a limit";
}

}  // namespace
}  // namespace hirosco::supervisor
