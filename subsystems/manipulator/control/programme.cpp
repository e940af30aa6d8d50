// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/programme.hpp"

#include "subsystems/manipulator/control/trajectory.hpp"

namespace hirosco::manipulator {
namespace {

/// Share of a way at constant speed with equal ramps at both ends.
double trapezoid(double past_s, double duration_s) noexcept {
  const double ramp = std::min(Legs::ramp_s, duration_s / 2);
  const double speed = 1 / (duration_s - ramp);
  if (past_s < ramp) return speed * past_s * past_s / (2 * ramp);
  const double left_s = duration_s - past_s;
  if (left_s < ramp) return 1 - speed * left_s * left_s / (2 * ramp);
  return speed * (past_s - ramp / 2);
}

}  // namespace

void Legs::add(const Leg& leg) noexcept {
  if (size_ < most) legs_[size_++] = leg;
}

Legs::Place Legs::advance(double span_s) noexcept {
  const Leg& leg = legs_[leg_];
  past_s_ = std::min(past_s_ + span_s, leg.duration_s);
  const Place place{leg_, leg.pace == Pace::MinimumJerk ? minimum_jerk(past_s_ / leg.duration_s)
                                                        : trapezoid(past_s_, leg.duration_s)};
  if (past_s_ >= leg.duration_s && !leg.tool) {
    ++leg_;
    past_s_ = 0;
  }
  return place;
}

std::optional<std::uint8_t> Legs::tool() const noexcept {
  if (done() || past_s_ < legs_[leg_].duration_s) return std::nullopt;
  return legs_[leg_].tool;
}

void Legs::tool_done() noexcept {
  if (!tool()) return;
  ++leg_;
  past_s_ = 0;
}

ToolWatch::Verdict ToolWatch::update(std::uint8_t holds) noexcept {
  if (!busy()) return Verdict::Idle;
  if (holds == wanted_) {
    forget();
    return Verdict::Done;
  }
  return --cycles_left_ > 0 ? Verdict::UnderWay : Verdict::Failed;
}

}  // namespace hirosco::manipulator
