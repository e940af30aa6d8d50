// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor::testing {

using enum descriptor::State;

inline constexpr std::uint16_t first_event = 2000, second_event = 2001;

/// ARM, and HAND, tell FIRST and SECOND, both of low severity, so that a plan alone says what weighs.
struct PlanRunsTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    for (auto& member : craft.mission.subsystems)
      for (const auto& [name, id] : {std::pair{"FIRST", first_event}, std::pair{"SECOND", second_event}}) {
        descriptor::Event event;
        event.name = name;
        event.id = id;
        event.severity = Severity::Low;
        member.subsystem.events.push_back(event);
      }
    start_all(Operational);
    parts.graph.set_up(1, true);
    for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
    parts.own.start(craft.mode_epoch);
    own_step();
  }
  void plan(std::string name, std::string event, std::uint8_t priority, std::vector<descriptor::PlanStep> steps) {
    descriptor::Plan made;
    made.name = std::move(name);
    made.event = std::move(event);
    made.priority = priority;
    made.steps = std::move(steps);
    craft.mission.plans.push_back(std::move(made));
  }
  void happens(std::uint16_t id, std::uint16_t to = arm) { event(to, id, Severity::Low); }
  /// Each telecommand that it has is completed, or not.
  void answered(std::uint16_t apid, std::uint8_t subtype = 7) {
    for (const auto& sent : received(apid)) verify(apid, sent.request, subtype, pus::FailureCode::ExecutionError);
  }
  static descriptor::PlanStep to_be(State state, std::string whom = {}) {
    return {"set_state", {static_cast<std::int64_t>(state)}, std::move(whom)};
  }
  static descriptor::PlanStep down(std::string whom = {}) { return {"shut_down_network", {}, std::move(whom)}; }
};

}  // namespace hirosco::supervisor::testing
