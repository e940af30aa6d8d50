// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/subsystem/moving_subsystem.hpp"

namespace hirosco::robotics {

Outcome MovingSubsystem::hold() noexcept {
  if (!moving_) return refused(codes_.inhibited);
  if (stop_) return refused(pus::FailureCode::Busy);
  end_motion(pus::FailureCode::Aborted);
  stand();
  return ok();
}

void MovingSubsystem::bind_hold_and_stop() {
  on_function("HOLD", [this]() { return hold(); });
  on_function("STOP", [this](Call call) -> Outcome {
    if (const Outcome held = hold(); held.kind == Outcome::Kind::Refused) return held;
    stop_ = call;
    return running;
  });
}

void MovingSubsystem::forget_motion() noexcept {
  motion_.reset();
  stop_.reset();
  moving_ = stopped_ = false;
}

void MovingSubsystem::finish_motion() noexcept {
  if (motion_) finish(*motion_);
  motion_.reset();
  motion_ended();
}

void MovingSubsystem::drop_calls(bool limit_tripped) noexcept {
  const auto why = limit_tripped ? codes_.limit_tripped : pus::FailureCode::Aborted;
  end_motion(why);
  if (stop_) abort(*stop_, why);
  stop_.reset();
}

void MovingSubsystem::at_rest_for_stop() noexcept {
  if (!stop_) return;
  finish(*stop_);
  stop_.reset();
  stopped_ = true;
}

}  // namespace hirosco::robotics
