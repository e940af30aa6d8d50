// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/model/supervisor_events.hpp"

/// What the steps of a recovery plan may be: the words of <Do>, with the attributes of each. What a step does is the
/// supervisor's (supervision/procedures), which does not compile while it lacks one of these (docs/adr/0057).
namespace hirosco::descriptor {

struct StepAttribute {
  enum class Kind : std::uint8_t {
    Number,
    SteadyState,
    SeenState,  ///< a steady state to be seen in, not commanded: Operational, too
    Word,
    Subsystem,  ///< of the mission; the value is its APID, 0 = the one that the step is for
    Function,  ///< of whom the step is for, or of anybody where that is not said; its place, its name is in the step's words
    Arguments,  ///< of that function, numbers, in the step
    Configuration,  ///< of whom the step is for, or of its `receiver`; its id
    Link,  ///< of the mission; its id
    Plan,  ///< of the mission, whose steps are taken in its place
  };
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
inline constexpr std::array function_to_call{
    StepAttribute{.name = "function", .kind = StepAttribute::Kind::Function},
    StepAttribute{.name = "arguments", .kind = StepAttribute::Kind::Arguments, .otherwise = 0},
    StepAttribute{.name = "done_within_s", .least = 15, .most = 600, .otherwise = 15}};
inline constexpr std::array notice_to_give{StepAttribute{.name = "function", .kind = StepAttribute::Kind::Function}};
inline constexpr std::array configuration_to_take{
    StepAttribute{.name = "configuration", .kind = StepAttribute::Kind::Configuration}};
inline constexpr std::array link_to_handle{StepAttribute{.name = "link", .kind = StepAttribute::Kind::Link}};
inline constexpr std::array state_to_wait_for{
    StepAttribute{.name = "state", .kind = StepAttribute::Kind::SeenState},
    StepAttribute{.name = "of", .kind = StepAttribute::Kind::Subsystem, .otherwise = 0},
    StepAttribute{.name = "within_ms", .least = 1, .most = 600'000, .otherwise = 10'000}};
inline constexpr std::array task_to_hand_over{
    StepAttribute{.name = "receiver", .kind = StepAttribute::Kind::Subsystem},
    StepAttribute{.name = "configuration", .kind = StepAttribute::Kind::Configuration}};
inline constexpr std::array power_to_spend{StepAttribute{.name = "budget_W", .least = 1, .most = 1'000'000}};
inline constexpr std::array plan_to_run{StepAttribute{.name = "plan", .kind = StepAttribute::Kind::Plan}};
}  // namespace detail

/// Where the values of a step with several are, each by the name of its attribute.
[[nodiscard]] consteval std::size_t place_of(std::span<const StepAttribute> attributes, std::string_view name) {
  return static_cast<std::size_t>(std::ranges::find(attributes, name, &StepAttribute::name) - attributes.begin());
}
inline constexpr std::size_t restart_limit = place_of(detail::restarts_with_limit, "limit");
inline constexpr std::size_t restart_within_s = place_of(detail::restarts_with_limit, "within_s");
inline constexpr std::size_t restart_pause_ms = place_of(detail::restarts_with_limit, "pause_ms");
/// Up to which state its subject comes back to what it was commanded to be; 0 = it stays Offline.
inline constexpr std::size_t restart_to = place_of(detail::restarts_with_limit, "to");
/// From when it is sent to its completion (docs/adr/0206).
inline constexpr std::size_t command_done_within_s = place_of(detail::function_to_call, "done_within_s");
inline constexpr std::size_t wait_for_state = place_of(detail::state_to_wait_for, "state");
inline constexpr std::size_t wait_for_of = place_of(detail::state_to_wait_for, "of");
inline constexpr std::size_t wait_for_within_ms = place_of(detail::state_to_wait_for, "within_ms");
inline constexpr std::size_t hand_over_receiver = place_of(detail::task_to_hand_over, "receiver");
inline constexpr std::size_t hand_over_configuration = place_of(detail::task_to_hand_over, "configuration");

/// Other than the rest no step of a flight: the reader puts the other plan's steps into its place.
inline constexpr std::string_view step_that_runs_a_plan = "run";

inline constexpr std::array plan_steps{
    StepWord{.name = "log"},
    StepWord{.name = "set_state", .attributes = detail::state_to_command, .names_subject = true},
    StepWord{.name = "shut_down_network", .names_subject = true},
    StepWord{.name = "restart", .attributes = detail::restarts_with_limit, .answers = event_of_death},
    StepWord{.name = "command", .attributes = detail::function_to_call, .names_subject = true},
    StepWord{.name = "configure", .attributes = detail::configuration_to_take, .names_subject = true},
    StepWord{.name = "link", .attributes = detail::link_to_handle},
    StepWord{.name = "unlink", .attributes = detail::link_to_handle},
    StepWord{.name = "fence", .names_subject = true},
    StepWord{.name = "kill", .names_subject = true},
    StepWord{.name = "wait_for", .attributes = detail::state_to_wait_for},
    StepWord{.name = "hand_over", .attributes = detail::task_to_hand_over},
    StepWord{.name = "notify_network", .attributes = detail::notice_to_give},
    StepWord{.name = "power", .attributes = detail::power_to_spend},
    StepWord{.name = step_that_runs_a_plan, .attributes = detail::plan_to_run},
};

/// Whether a network can be told by it that one of its members has failed: no argument, or the APID of that.
[[nodiscard]] inline bool is_notice(const Function& function) noexcept {
  return function.arguments.empty() ||
         (function.arguments.size() == 1 && function.arguments[0].field.type == Type::Uint16 &&
          function.arguments[0].field.count == 1);
}

/// Null: there is no such word.
[[nodiscard]] constexpr const StepWord* find_plan_step(std::string_view name) noexcept {
  const auto* const found = std::ranges::find(plan_steps, name, &StepWord::name);
  return found != plan_steps.end() ? found : nullptr;
}

}  // namespace hirosco::descriptor
