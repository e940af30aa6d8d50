// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>
#include <vector>

#include "hirosco/descriptor/plan_steps.hpp"
#include "supervisor/supervision/procedures/steps/configure.hpp"
#include "supervisor/supervision/procedures/steps/link.hpp"
#include "supervisor/supervision/procedures/steps/log.hpp"
#include "supervisor/supervision/procedures/steps/restart.hpp"
#include "supervisor/supervision/procedures/steps/set_mode.hpp"
#include "supervisor/supervision/procedures/steps/set_state.hpp"
#include "supervisor/supervision/procedures/steps/shut_down_network.hpp"

namespace hirosco::supervisor {

/// All kinds of steps, here and nowhere else. Those that a mission's plans may name have a word in plan_steps.hpp besides.
inline constexpr std::array step_kinds{&steps::log,       &steps::set_state, &steps::shut_down_network, &steps::restart,
                                       &steps::configure, &steps::link,      &steps::set_mode};

/// Null: there is none of this name.
[[nodiscard]] constexpr const StepKind* find_step_kind(std::string_view name) noexcept {
  const auto found = std::ranges::find(step_kinds, name, [](const StepKind* kind) { return kind->name; });
  return found != step_kinds.end() ? *found : nullptr;
}

static_assert(std::ranges::all_of(descriptor::plan_steps,
                                  [](const descriptor::StepWord& word) {
                                    const StepKind* kind = find_step_kind(word.name);
                                    return kind != nullptr && kind->values == word.attributes.size();
                                  }),
              "what a mission may write is done by somebody, with all its attributes");

/// The name of a kind in code: another than those of the table does not compile.
struct KnownKind {
  consteval KnownKind(const char* name) : kind{find_step_kind(name)} {
    if (kind == nullptr) throw "no such kind of step";
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
