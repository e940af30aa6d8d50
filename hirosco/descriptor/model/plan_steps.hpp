// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "hirosco/descriptor/model/supervisor_events.hpp"

/// What the steps of a recovery plan may be: the words of <Do>, with the attributes of each. What a step does is the
/// supervisor's (supervision/procedures), which does not compile while it lacks one of these (docs/adr/0057).
namespace hirosco::descriptor {

struct StepAttribute {
  enum class Kind : std::uint8_t { Number, SteadyState, Word };
  struct Word {
    std::string_view text;
    std::int64_t value{};
  };
  std::string_view name;
  Kind kind{Kind::Number};
  std::int64_t least{0}, most{0};
  std::optional<std::int64_t> otherwise{};  ///< empty: it has to be given
  std::span<const Word> words{};
};

struct StepWord {
  std::string_view name;
  std::span<const StepAttribute> attributes{};
  std::string_view answers{};  ///< the only event that it is for; empty: any
  bool names_subject{false};  ///< it may name whom it moves; else it is for whose event it is
};

namespace detail {
inline constexpr std::array state_to_command{StepAttribute{.name = "state", .kind = StepAttribute::Kind::SteadyState}};
/// The state up to which it comes back to what it was commanded to be; the values are those of State.
inline constexpr std::array states_to_come_back_to{
    StepAttribute::Word{"Offline", 0}, StepAttribute::Word{"PreOperational", 3},
    StepAttribute::Word{"SafeOperational", 4}, StepAttribute::Word{"commanded", 5}};
inline constexpr std::array restarts_with_limit{
    StepAttribute{.name = "limit", .least = 1, .most = 100'000, .otherwise = 3},
    StepAttribute{.name = "within_s", .least = 1, .most = 86'400, .otherwise = 60},
    StepAttribute{.name = "pause_ms", .least = 0, .most = 60'000, .otherwise = 100},
    StepAttribute{.name = "to", .kind = StepAttribute::Kind::Word, .otherwise = 0, .words = states_to_come_back_to}};
}  // namespace detail

/// Of the values of `restart`: up to which state its subject comes back to what it was commanded to be; 0 = it stays Offline.
inline constexpr std::size_t restart_to = 3;

inline constexpr std::array plan_steps{
    StepWord{.name = "log"},
    StepWord{.name = "set_state", .attributes = detail::state_to_command, .names_subject = true},
    StepWord{.name = "shut_down_network", .names_subject = true},
    StepWord{.name = "restart", .attributes = detail::restarts_with_limit, .answers = event_of_death},
};

/// Null: there is no such word.
[[nodiscard]] constexpr const StepWord* find_plan_step(std::string_view name) noexcept {
  const auto* const found = std::ranges::find(plan_steps, name, &StepWord::name);
  return found != plan_steps.end() ? found : nullptr;
}

}  // namespace hirosco::descriptor
