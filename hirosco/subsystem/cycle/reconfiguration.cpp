// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/reconfiguration.hpp"

#include "hirosco/subsystem/cycle/cycle.hpp"

namespace hirosco {
namespace {

[[nodiscard]] int member_of(const descriptor::ParameterRef& reference) noexcept {
  return reference.member ? static_cast<int>(*reference.member) : -1;
}

}  // namespace

Reconfiguration Reconfiguration::make(const descriptor::Configuration& from, const descriptor::Configuration& to,
                                      const descriptor::Bumpless& terms, const Dictionary& dictionary) {
  Reconfiguration made{.from = &from, .to = &to, .terms = &terms, .sampler = nullptr, .before = {}};
  for (const auto& initial : to.initial)
    made.before.emplace_back(dictionary.wire_octets(initial.parameter.parameter, member_of(initial.parameter)));
  return made;
}

Result<> Reconfiguration::set_values(Dictionary& dictionary) noexcept {
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto& [parameter, values] = to->initial[i];
    const int member = member_of(parameter);
    Result<> set = fail(ErrorCode::Mismatch, "an initial value");
    if (dictionary.encode(parameter.parameter, member, before[i]) == before[i].size())
      set = dictionary.set(parameter.parameter, member, values);
    if (set) continue;
    restore(dictionary, i);
    return set;
  }
  return ok();
}

/// Backwards: what was set twice has its first value again.
void Reconfiguration::restore(Dictionary& dictionary, std::size_t values) noexcept {
  for (std::size_t i = values; i > 0; --i) {
    const auto& parameter = to->initial[i - 1].parameter;
    static_cast<void>(dictionary.decode_into(parameter.parameter, member_of(parameter), before[i - 1]));
  }
}

// --- the cycle ---------------------------------------------------------------------------------------------------------

/// What of a configuration the cycle counts begins anew; its state, links and devices stay.
void CycleLoop::begin_counting(const descriptor::Configuration& configuration) noexcept {
  in_force_.store(&configuration, std::memory_order_release);
  count_ = 0;
  silence_limit_ = supervisor_silence_cycles(configuration.sampling);
  overruns_.begin(configuration, parts_.realtime);
  latency_max_ns_ = 0;
  execution_max_ns_ = 0;
  execution_mean_ns_ = 0.0;
  times_ = {};
  statistics_.store({});
  times_parameter_.store({});
  pace_.begin(configuration, parts_.precise);
  budget_.begin(configuration, parts_.realtime, pace_.wait().spin);
  realtime_.begin(configuration.shortest());
  budget_parameter_.store(budget_.told());
  spin_parameter_.store(budget_.told_spin());
}

/// Whether it may be: the guard, the second inhibit and the state are asked in the cycle, as it is taken over there.
const char* CycleLoop::why_not(const Reconfiguration& wanted) const noexcept {
  if (plan_.configuration != wanted.from) return "another configuration is in force";
  if (!controlling()) return "neither Safe-Operational nor Operational";
  if (self_test_.running()) return "a self test runs";
  const bool permitted = permit().stop.load(std::memory_order_acquire) == 0 &&
                         permit().permits(permit().epoch.load(std::memory_order_acquire));
  if (state_ == State::Operational && (!permitted || inhibited_ != 0)) return "the actuators are inhibited";
  return nullptr;
}

void CycleLoop::reconfigure(Reconfiguration& wanted, TimePoint planned) noexcept {
  const auto refuse = [&](const Error& why) {
    const AuthorsError reason{why};
    answer({.kind = ReportKind::NotReconfigured, .index = wanted.to->id}, std::as_bytes(std::span{&reason, 1}));
  };
  if (const char* const why = why_not(wanted)) return refuse({ErrorCode::NotPermitted, why});
  if (const auto set = wanted.set_values(parts_.dictionary); !set) return refuse(set.error());
  const Cycle cycle{.planned = planned,
                    .period = wanted.to->sampling,
                    .count = 0,
                    .state = state_,
                    .first = false,
                    .active = state_ == State::Operational};
  if (const auto taken = parts_.author.bumpless(*wanted.from, *wanted.to, cycle); !taken) {
    wanted.restore_values(parts_.dictionary);
    return refuse(taken.error());
  }
  plan_.configuration = wanted.to;
  plan_.sampler = wanted.sampler;
  for (DeviceSlot& device : plan_.devices) device.follow(wanted.to->sampling);
  for (LinkInputSlot& input : plan_.inputs) input.follow(wanted.to->sampling);
  begin_counting(*wanted.to);
  parts_.vital.period_ns.store(static_cast<std::uint64_t>(wanted.to->sampling.count()), std::memory_order_relaxed);
  parts_.vital.configuration.store(wanted.to->id, std::memory_order_release);
  taken_over_ = &wanted;
}

/// In the cycle that took a configuration over, before anything is put out: what jumps beyond its declared step reaches no actuator.
void CycleLoop::end_reconfiguration() noexcept {
  const Reconfiguration* const taken = std::exchange(taken_over_, nullptr);
  if (taken == nullptr) return;
  const bool active = state_ == State::Operational && inhibited_ == 0;
  for (DeviceSlot& device : plan_.devices) {
    if (!active || !device.would_jump(parts_.descriptor, *taken->terms)) continue;
    inhibit(inhibited_by_failure);
    const AuthorsError why{Error{ErrorCode::OutOfRange, "an output jumps where the configuration changes"}};
    const Octets said = std::as_bytes(std::span{&why, 1});
    answer({.kind = ReportKind::NotReconfigured, .index = taken->to->id}, said);
    return answer({.kind = ReportKind::NodeFailed, .index = static_cast<std::uint16_t>(state_)}, said);
  }
  report(ReportKind::Reconfigured, taken->to->id, {});
}

}  // namespace hirosco
