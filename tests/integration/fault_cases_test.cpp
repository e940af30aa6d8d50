// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// The fault cases of the rokviss mission at seeded instants: how long the acting member took, counted in its own cycles
// from the detection, and what became of the craft. Five times each; HIROSCO_REPETITIONS says otherwise.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "simulation/world/random.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using simulation::JoystickDevice;
using simulation::Random;
using simulation::RobotDevice;
using simulation::Vec2;

const std::uint64_t repetitions = [] {
  const char* wanted = std::getenv("HIROSCO_REPETITIONS");
  return wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 5;
}();
constexpr int most_cycles_to_safe = 5;

/// One flight with the finger on the rail and the hand feeling it.
struct Case {
  explicit Case(std::uint64_t seed, const std::string& mode = "telepresence") : random{seed} {
    flight.emplace(Plan{.edit =
                            [&](descriptor::Mission& mission) {
                              hand_rests(mission);
                              mission.start_mode = mode;
                            },
                        .seed = seed});
    if (!flight->commission()) throw std::runtime_error{flight->story().text()};
    robot = &flight->device<RobotDevice>("robot");
    joystick = &flight->device<JoystickDevice>("joystick");
  }
  void hand(const std::string& line) {
    if (!joystick->hand(line)) throw std::runtime_error{line};
  }
  void press() {
    hand("cartesian 0.0226 0 0.5");
    run_s(random.uniform(0.7, 0.9));
  }
  void run_s(double span_s) { flight->craft().run(Duration{std::llround(span_s * 1e9)}); }
  [[nodiscard]] double now_ms() { return seconds(flight->craft().now() - TimePoint{}) * 1e3; }

  /// Injects, and watches until `safe` after `detected`; both are asked after each cycle of the acting member.
  struct Watch {
    std::string acting;
    std::function<bool()> detected;
    std::function<bool()> safe;
    std::string event;  ///< part of the line that tells of it
  };
  void inject(const Watch& watch, const std::function<void()>& fault) {
    const double began_ms = now_ms();
    flight->story().on_line = [this, began_ms, event = watch.event](std::string_view line) {
      if (event_ms < 0 && line.find(event) != line.npos) event_ms = now_ms() - began_ms;
    };
    bool seen = false;
    flight->craft().on_cycle([&, watch, began_ms](std::string_view subsystem, TimePoint) {
      if (cycles_to_safe) return;
      const bool acts = subsystem == watch.acting;
      if (seen && acts) ++counted;
      if (!seen && watch.detected()) {
        seen = true;
        detected_ms = now_ms() - began_ms;
      }
      if (seen && watch.safe()) cycles_to_safe = counted;
    });
    fault();
    run_s(0.2);
    flight->craft().on_cycle({});
  }
  [[nodiscard]] bool inhibited(const char* subsystem, std::uint32_t reason) {
    return (flight->inhibited(subsystem) & reason) != 0;
  }
  [[nodiscard]] bool both_offline_in_time() {
    return flight->run_until_state("MANIPULATOR", State::Offline, 1800ms) &&
           flight->run_until_state("JOYSTICK", State::Offline, 1800ms);
  }

  Random random;
  std::optional<Flight> flight;
  RobotDevice* robot{nullptr};
  JoystickDevice* joystick{nullptr};
  int counted{0};
  std::optional<int> cycles_to_safe;
  double detected_ms{-1};  ///< since the injection
  double event_ms{-1};  ///< since the injection
};

/// The worst of all repetitions.
struct Worst {
  int cycles{-1};
  double event_ms{0};
  std::uint64_t complete{0};

  /// `event_limit_ms` after the injection; `outcome`: what else had to come.
  void take(const Case& seen, double event_limit_ms, bool outcome) {
    const bool in_time = seen.cycles_to_safe && *seen.cycles_to_safe <= most_cycles_to_safe;
    cycles = std::max(cycles, seen.cycles_to_safe.value_or(9999));
    event_ms = std::max(event_ms, seen.event_ms < 0 ? 9999 : seen.event_ms);
    if (in_time && seen.event_ms >= 0 && seen.event_ms <= event_limit_ms && outcome) ++complete;
  }
  void judge(const char* name, const char* acting) const {
    const std::string safe =
        cycles < 0 ? std::string{"stays as it is"} : fmt::format("safe after {} of its cycles (at most 5)", cycles);
    std::cout << fmt::format("{:4} {:13} {:40} event after {:7.2f} ms, {} of {}\n", name, acting, safe, event_ms,
                             complete, repetitions);
    EXPECT_EQ(complete, repetitions) << name;
  }
};

template <class Repetition>
void repeat(const char* name, const char* acting, const Repetition& repetition) {
  Worst worst;
  for (std::uint64_t seed = 1; seed <= repetitions; ++seed) repetition(seed, worst);
  worst.judge(name, acting);
}

TEST(FaultCases, FC1ATorqueAboveTheLimitStopsTheRobotAndLeavesTheJoystickRunning) {
  repeat("FC1", "MANIPULATOR", [](std::uint64_t seed, Worst& worst) {
    Case flown{seed};
    flown.inject({.acting = "MANIPULATOR",
                  .detected = [&] { return flown.inhibited("MANIPULATOR", inhibited_by_author); },
                  .safe = [&] { return !flown.robot->active(); },
                  .event = "medium TORQUE_LIMIT_EXCEEDED"},
                 [&] {
                   flown.hand(fmt::format("ramp 0.065 0 {}", flown.random.uniform(0.035, 0.055)));
                   flown.run_s(1.2);
                 });
    if (flown.event_ms >= 0) flown.event_ms -= flown.detected_ms;  // three cycles after the trip at most
    worst.take(flown, 1.5,
               flown.flight->state("MANIPULATOR") == State::SafeOperational &&
                   flown.flight->state("JOYSTICK") == State::Operational &&
                   flown.joystick->motor_torque_n_m() == Vec2{});
  });
}

TEST(FaultCases, FC2ACriticalTemperatureStopsTheRobot) {
  repeat("FC2", "MANIPULATOR", [](std::uint64_t seed, Worst& worst) {
    Case flown{seed};
    flown.press();
    flown.inject({.acting = "MANIPULATOR",
                  .detected = [&] { return flown.inhibited("MANIPULATOR", inhibited_by_author); },
                  .safe = [&] { return !flown.robot->active(); },
                  .event = "medium TEMPERATURE_CRITICAL"},
                 [&] { ASSERT_TRUE(flown.robot->fault(fmt::format("temperature {} 75", 1 + seed % 2))); });
    worst.take(flown, 10,
               flown.flight->state("MANIPULATOR") == State::SafeOperational &&
                   flown.flight->state("JOYSTICK") == State::Operational);
  });
}

TEST(FaultCases, FC3AnUnpluggedJoystickStopsTheRobot) {
  repeat("FC3", "MANIPULATOR", [](std::uint64_t seed, Worst& worst) {
    Case flown{seed};
    flown.press();
    flown.inject({.acting = "MANIPULATOR",
                  .detected = [&] { return flown.inhibited("JOYSTICK", inhibited_by_device); },
                  .safe = [&] { return !flown.robot->active(); },
                  .event = "high JOYSTICK_LOST"},
                 [&] { ASSERT_TRUE(flown.joystick->fault("unplug")); });
    worst.take(flown, 2, flown.both_offline_in_time());
  });
}

TEST(FaultCases, FC4AnUnpluggedRobotLeavesTheHandWithoutForce) {
  repeat("FC4", "JOYSTICK", [](std::uint64_t seed, Worst& worst) {
    Case flown{seed};
    flown.press();
    flown.inject({.acting = "JOYSTICK",
                  .detected = [&] { return flown.inhibited("MANIPULATOR", inhibited_by_device); },
                  .safe = [&] { return flown.joystick->motor_torque_n_m() == Vec2{}; },
                  .event = "high ROBOT_LOST"},
                 [&] { ASSERT_TRUE(flown.robot->fault("unplug")); });
    worst.take(flown, 2, flown.both_offline_in_time());
  });
}

TEST(FaultCases, FC5ADeadJoystickProcessStopsTheRobot) {
  repeat("FC5", "MANIPULATOR", [](std::uint64_t seed, Worst& worst) {
    Case flown{seed};
    flown.press();
    flown.inject({.acting = "MANIPULATOR",
                  .detected = [&] { return flown.flight->inhibited("MANIPULATOR") != 0; },
                  .safe = [&] { return !flown.robot->active(); },
                  .event = "JOYSTICK died"},
                 [&] { flown.flight->craft().kill("JOYSTICK"); });
    worst.take(flown, 10, flown.both_offline_in_time());  // the supervisor looks every 10 ms
  });
}

TEST(FaultCases, FC6AHungJoystickStopsTheRobotAndIsFoundBySupervisor) {
  repeat("FC6", "MANIPULATOR", [](std::uint64_t seed, Worst& worst) {
    Case flown{seed};
    flown.press();
    flown.inject({.acting = "MANIPULATOR",
                  .detected = [&] { return flown.flight->inhibited("MANIPULATOR") != 0; },
                  .safe = [&] { return !flown.robot->active(); },
                  .event = "JOYSTICK hangs"},
                 [&] { flown.flight->craft().stop("JOYSTICK", true); });
    // 20 of the supervisor's own cycles of 10 ms.
    worst.take(flown, 220, flown.flight->run_until_state("MANIPULATOR", State::Offline, 1800ms));
  });
}

TEST(FaultCases, FC7AStaleLinkStopsTheRobotAndBringsItToSafeOperational) {
  repeat("FC7", "MANIPULATOR", [](std::uint64_t seed, Worst& worst) {
    Case flown{seed};
    flown.press();
    flown.inject({.acting = "MANIPULATOR",
                  .detected = [&] { return flown.inhibited("MANIPULATOR", inhibited_by_link); },
                  .safe = [&] { return !flown.robot->active(); },
                  .event = "medium JOYSTICK_STATE_STALE"},
                 [&] {
                   // Too short for a hang: the joystick misses six of its cycles and goes on.
                   flown.flight->craft().stop("JOYSTICK", true);
                   flown.run_s(0.003);
                   flown.flight->craft().stop("JOYSTICK", false);
                 });
    worst.take(flown, 10,
               flown.flight->state("MANIPULATOR") == State::SafeOperational &&
                   flown.flight->state("JOYSTICK") == State::Operational);
  });
}

TEST(FaultCases, FC8ALostGroundLinkHoldsTheRobotAndIsToldAfterTwoSeconds) {
  Worst worst;
  for (std::uint64_t seed = 1; seed <= repetitions; ++seed) {
    Case flown{seed, "remote"};
    flown.hand("sine 1 0.1 0.5");
    flown.run_s(flown.random.uniform(0.5, 1.5));
    double began_ms = 0, event_ms = -1;
    flown.flight->story().on_line = [&](std::string_view line) {
      if (line.find("medium GROUND_LINK_LOST") != line.npos) event_ms = flown.now_ms() - began_ms;
    };
    began_ms = flown.now_ms();
    ASSERT_TRUE(flown.flight->craft().command("COMMUNICATION", "SET_DELAY", {20, 1}).completed);
    flown.run_s(1);
    const Vec2 held = flown.robot->arm().state().link_rad;
    flown.run_s(1.2);
    const Vec2 now = flown.robot->arm().state().link_rad;
    const bool holds = std::abs(now[0] - held[0]) < 1e-3 && flown.flight->state("MANIPULATOR") == State::Operational;
    worst.event_ms = std::max(worst.event_ms, event_ms < 0 ? 9999 : event_ms);
    if (holds && event_ms >= 2000 && event_ms < 2060) ++worst.complete;  // and the way of the command
  }
  worst.judge("FC8", "COMMUNICATION");
}

TEST(FaultCases, FC13WhatIsLowIsToldAndNothingElseHappens) {
  Worst worst;
  for (std::uint64_t seed = 1; seed <= repetitions; ++seed) {
    Case flown{seed};
    flown.run_s(flown.random.uniform(0.1, 0.2));
    static_cast<void>(flown.flight->craft().command("MANIPULATOR", "HOOK_SPRING", {1}));
    flown.run_s(0.1);
    if (flown.flight->story().has("MANIPULATOR low SPRING_OUT_OF_REACH") && !flown.flight->story().has("plan ") &&
        flown.flight->state("MANIPULATOR") == State::Operational && flown.robot->active())
      ++worst.complete;
  }
  worst.judge("FC13", "MANIPULATOR");
}

}  // namespace
}  // namespace hirosco::testing
