// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "supervisor/supervision/procedures/steps/await_power.hpp"
#include "supervisor/supervision/procedures/steps/command.hpp"
#include "supervisor/supervision/procedures/steps/configure.hpp"
#include "supervisor/supervision/procedures/steps/enter_mode.hpp"
#include "supervisor/supervision/procedures/steps/fence.hpp"
#include "supervisor/supervision/procedures/steps/hand_over.hpp"
#include "supervisor/supervision/procedures/steps/kill.hpp"
#include "supervisor/supervision/procedures/steps/link.hpp"
#include "supervisor/supervision/procedures/steps/log.hpp"
#include "supervisor/supervision/procedures/steps/notify_network.hpp"
#include "supervisor/supervision/procedures/steps/power.hpp"
#include "supervisor/supervision/procedures/steps/recall.hpp"
#include "supervisor/supervision/procedures/steps/restart.hpp"
#include "supervisor/supervision/procedures/steps/self_test.hpp"
#include "supervisor/supervision/procedures/steps/set_state.hpp"
#include "supervisor/supervision/procedures/steps/shut_down_network.hpp"
#include "supervisor/supervision/procedures/steps/unlink.hpp"
#include "supervisor/supervision/procedures/steps/wait_for.hpp"

namespace hirosco::supervisor {

/// All kinds of steps, here and nowhere else. Those that a mission's plans may name have a word in plan_steps.hpp besides.
inline constexpr std::array step_kinds{&steps::log,
                                       &steps::set_state,
                                       &steps::shut_down_network,
                                       &steps::restart,
                                       &steps::configure,
                                       &steps::link,
                                       &steps::self_test,
                                       &steps::enter_mode,
                                       &steps::recall,
                                       &steps::command,
                                       &steps::unlink,
                                       &steps::fence,
                                       &steps::kill,
                                       &steps::wait_for,
                                       &steps::hand_over,
                                       &steps::notify_network,
                                       &steps::power,
                                       &steps::await_power};

/// Place in the table; its size when there is none of this name. (With sanitizers a comparison with null is no constant.)
[[nodiscard]] constexpr std::size_t place_of_step_kind(std::string_view name) noexcept {
  std::size_t place = 0;
  while (place < step_kinds.size() && step_kinds[place]->name != name) ++place;
  return place;
}

/// Null: there is none of this name.
[[nodiscard]] constexpr const StepKind* find_step_kind(std::string_view name) noexcept {
  const std::size_t place = place_of_step_kind(name);
  return place < step_kinds.size() ? step_kinds[place] : nullptr;
}

static_assert(std::ranges::all_of(descriptor::plan_steps,
                                  [](const descriptor::StepWord& word) {
                                    const std::size_t place = place_of_step_kind(word.name);
                                    return word.name == descriptor::step_that_runs_a_plan ||
                                           (place < step_kinds.size() &&
                                            step_kinds[place]->values == word.attributes.size());
                                  }),
              "what a mission may write is done by somebody, with all its attributes");

/// The name of a kind in code: another than those of the table does not compile.
struct KnownKind {
  consteval KnownKind(const char* name) : kind{step_kinds[place_of_step_kind(name) % step_kinds.size()]} {
    if (place_of_step_kind(name) == step_kinds.size()) throw "no such kind of step";
  }
  const StepKind* kind;
};

[[nodiscard]] inline ProcedureStep step(KnownKind known, std::uint16_t subject, std::vector<std::int64_t> values) {
  assert(known.kind->values == values.size());
  return {.kind = known.kind, .subject = subject, .values = std::move(values)};
}
[[nodiscard]] inline ProcedureStep to_state(std::uint16_t subject, State state) {
  return step("set_state", subject, {static_cast<std::int64_t>(state)});
}

}  // namespace hirosco::supervisor
