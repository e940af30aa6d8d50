// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/self_test_run.hpp"

#include <chrono>

namespace hirosco {

void SelfTestRun::forget() noexcept {
  passed_.store(false, std::memory_order_release);
  running_ = false;
}

void SelfTestRun::begin(const pus::Request& request, Duration within) noexcept {
  passed_.store(false, std::memory_order_release);
  running_ = true;
  request_ = request;
  within_ = within;
  begun_.reset();
}

bool SelfTestRun::first(TimePoint planned) noexcept {
  if (begun_) return false;
  begun_ = planned;
  return true;
}

void SelfTestRun::take(const Result<Step>& said, TimePoint planned) noexcept {
  if (!said) return end(pus::FailureCode::ExecutionError, said.error());
  if (*said == Step::Done) return end(pus::FailureCode{}, {});
  if (planned - begun_.value_or(planned) < within_) return;
  end(pus::FailureCode::Timeout,
      {ErrorCode::Timeout, "self test: not done in its time, ms", within_ / std::chrono::milliseconds{1}});
}

void SelfTestRun::leave(descriptor::State to) noexcept {
  if (to == descriptor::State::ErrorOperational) passed_.store(false, std::memory_order_release);
  if (to == descriptor::State::SafeOperational) return;
  end(pus::FailureCode::Aborted,
      {ErrorCode::NotPermitted, "self test: the subsystem went to state", static_cast<std::int64_t>(to)});
}

void SelfTestRun::lose_device(std::int64_t index) noexcept {
  passed_.store(false, std::memory_order_release);
  end(pus::FailureCode::Aborted, {ErrorCode::Unavailable, "self test: a device was lost, number", index});
}

void SelfTestRun::fail_node() noexcept {
  end(pus::FailureCode::Aborted, {ErrorCode::Unavailable, "self test: the node of Safe-Operational failed"});
}

void SelfTestRun::end(pus::FailureCode code, const Error& why) noexcept {
  if (!running_) return;
  running_ = false;
  passed_.store(code == pus::FailureCode{}, std::memory_order_release);
  reports_.explain({.kind = ReportKind::SelfTestEnded, .index = static_cast<std::uint16_t>(code), .request = request_},
                   why);
}

}  // namespace hirosco
