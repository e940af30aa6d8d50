// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/tasks.hpp"

namespace hirosco::manipulator {

void Tasks::forget() noexcept {
  for (auto* call : {&move_, &programme_call_, &tool_call_}) call->reset();
  programme_ = nullptr;
  tool_.forget();
}

// --- functions -----------------------------------------------------------------------------------------------------------

void Tasks::move(const Joints& target_rad, double duration_s, const Call& call) noexcept {
  parts_.setpoint.set_out(target_rad, duration_s);
  arrival_.start();
  move_ = call;
  half_reported_ = false;
}

void Tasks::run(Programme& programme, const Call& call) noexcept {
  programme_ = &programme;
  programme_call_ = call;
  arrival_.start();
  reported_leg_ = 0;
}

void Tasks::use_tool(std::uint8_t wanted, const Call& call) noexcept {
  tool_call_ = call;
  tool_.want(wanted);
}

// --- in each cycle -------------------------------------------------------------------------------------------------------

Tasks::News Tasks::advance(double span_s) noexcept {
  return programme_ != nullptr ? advance_programme(span_s) : advance_motion(span_s);
}

Tasks::News Tasks::advance_motion(double span_s) noexcept {
  parts_.setpoint.go_on(span_s);
  if (!move_) return {};
  const Trajectory& path = parts_.setpoint.path();
  News news{.call = *move_};
  if (!half_reported_ && path.progress() >= 0.5) {
    half_reported_ = true;
    news.step = std::uint16_t{1};
  }
  if (path.done()) news.end = arrive(move_, path.target_rad(), span_s);
  return news;
}

Tasks::News Tasks::advance_programme(double span_s) noexcept {
  parts_.setpoint.ask(programme_->advance(span_s));
  if (const auto wanted = programme_->tool(); wanted && !tool_call_) {
    tool_call_ = programme_call_;
    tool_.want(*wanted);
  }
  News news{.call = *programme_call_};
  if (programme_->leg() != reported_leg_ && !programme_->done()) {
    reported_leg_ = programme_->leg();
    news.step = static_cast<std::uint16_t>(reported_leg_);
  }
  if (!programme_->done()) return news;
  news.end = arrive(programme_call_, programme_->goal_rad(), span_s);
  if (!programme_call_) programme_ = nullptr;
  return news;
}

/// The end of a path is not yet the goal: a motion is done when it is measured there.
Tasks::News::End Tasks::arrive(std::optional<Call>& call, const Joints& goal_rad, double span_s) noexcept {
  using Verdict = Arrival::Verdict;
  const Verdict verdict =
      arrival_.judge(parts_.drives.sensed().position_rad, goal_rad, parts_.parameters.goal_tolerance.load(), span_s);
  if (verdict == Verdict::UnderWay) return News::End::None;
  call.reset();
  parts_.setpoint.hold();
  return verdict == Verdict::There ? News::End::There : News::End::Missed;
}

Tasks::News Tasks::watch_tool() noexcept {
  using Verdict = ToolWatch::Verdict;
  const Verdict verdict = tool_.update(parts_.drives.sensed().tool);
  News news;
  if (verdict == Verdict::Done) {
    if (programme_ != nullptr) programme_->tool_done();
    else news = {.call = *tool_call_, .end = News::End::ToolHolds};
    tool_call_.reset();
  } else if (verdict == Verdict::Failed) {
    news = {.call = *tool_call_, .end = News::End::ToolFailed};
    tool_call_.reset();
    if (programme_ == nullptr) return news;
    programme_call_.reset();
    programme_ = nullptr;
    parts_.setpoint.hold();
  }
  return news;
}

}  // namespace hirosco::manipulator
