// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/realtime_watch.hpp"

#include <algorithm>

namespace hirosco {
namespace {

[[nodiscard]] const char* name_of_node(State state) noexcept {
  if (state == State::PreOperational) return "pre_operational()";
  if (state == State::SafeOperational) return "safe_operational()";
  return state == State::Operational ? "operational()" : "error_operational()";
}

}  // namespace

AuthorCall::AuthorCall(AuthorUses& first, State state) noexcept : AuthorCall{first, name_of_node(state)} {}

void RealtimeWatch::begin(Duration sampling) noexcept {
  pause_cycles_ = static_cast<std::uint64_t>(std::max<std::int64_t>(Duration{1s} / sampling, 1));
  rest_cycles_ = 0;
  sum_ = told_ = {};
}

bool RealtimeWatch::account(const RealtimeUses& of_cycle) noexcept {
  if (rest_cycles_ > 0) --rest_cycles_;
  sum_ = {sum_.heap + of_cycle.heap, sum_.locks + of_cycle.locks, sum_.outputs + of_cycle.outputs};
  if (sum_ == told_ || rest_cycles_ > 0) return false;
  told_ = sum_;
  rest_cycles_ = pause_cycles_;
  return true;
}

bool HeapWatch::account(const AllocationCount& of_step, TimePoint now) noexcept {
  sum_ = {sum_.allocations + of_step.allocations, sum_.frees + of_step.frees, sum_.octets + of_step.octets};
  if (sum_ == told_ || now < again_) return false;
  told_ = sum_;
  again_ = now + 1s;
  return true;
}

}  // namespace hirosco
