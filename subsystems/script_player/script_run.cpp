// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/script_player/script_run.hpp"

#include <cmath>
#include <utility>

namespace hirosco::script_player {
namespace {

using Kind = pus::ScriptLine::Kind;
using RequestStage = RequestReport::Stage;

/// A parameter that is waited for is asked for so often: each is a telecommand of the log.
constexpr Duration between_looks = std::chrono::milliseconds{200};

[[nodiscard]] Duration duration_of(double seconds) { return Duration{std::llround(seconds * 1e9)}; }
/// Without the zeros of std::to_string.
[[nodiscard]] std::string text_of(double number) {
  std::string text = std::to_string(number);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

void ScriptRun::begin(const pus::Script& script, TimePoint now) {
  *this = {};
  script_ = &script;
  progress_ = Progress::Playing;
  last_ = now;
}

Progress ScriptRun::progress() const noexcept { return active() && held_ ? Progress::Held : progress_; }

void ScriptRun::step(TimePoint now, Stage& stage) {
  if (!active()) return;
  if (!(held_ && phase_ == Phase::Between)) time_s_ += seconds(now - last_);
  last_ = now;
  // A line that takes no time is followed at once; no more of them in one step than the script has.
  for (std::size_t i = 0; i <= pus::most_script_lines && active(); ++i) {
    const std::size_t before = next_;
    go_on(now, stage);
    if (next_ == before) return;
  }
}

void ScriptRun::go_on(TimePoint now, Stage& stage) {
  if (phase_ == Phase::Between) {
    if (held_) return;
    if (next_ == script_->lines.size()) {
      progress_ = Progress::Ended;
      return;
    }
    const pus::ScriptLine& line = script_->lines[next_];
    if (time_s_ < line.not_before_s) return;
    number_ = line.number;
    begin_line(now, stage);
    return;
  }
  const pus::ScriptLine& line = script_->lines[next_];
  if (line.kind == Kind::Until) {
    look(now, stage);
    return;
  }
  if (line.kind == Kind::Event && stage.was_heard(next_)) return end_line();
  if (line.kind == Kind::Telecommand && phase_ == Phase::Waiting) {
    begin_line(now, stage);  // the supervisor was behind
    return;
  }
  if (now < deadline_) return;
  if (line.kind == Kind::Wait) return end_line();
  if (line.kind == Kind::Event) fail("not heard within " + text_of(line.seconds) + " s");
  else fail("no end within " + text_of(limit_s_) + " s");
}

void ScriptRun::begin_line(TimePoint now, Stage& stage) {
  const pus::ScriptLine& line = script_->lines[next_];
  const bool first = phase_ == Phase::Between;
  if (line.kind == Kind::Limit) {
    limit_s_ = line.seconds;
    return end_line();
  }
  if (first) deadline_ = now + duration_of(line.kind == Kind::Telecommand ? limit_s_ : line.seconds);
  phase_ = Phase::Waiting;
  if (line.kind != Kind::Telecommand) {
    next_look_ = now;
    seen_.reset();
    return go_on(now, stage);  // it may be there already
  }
  if (first) stage.forget_events();
  const auto asked = stage.ask(next_);
  if (asked) {
    open_ = *asked;
    phase_ = Phase::Asked;
  } else if (asked.error().code != ErrorCode::ResourceExhausted || now >= deadline_) {
    fail(asked.error().text);
  }
}

void ScriptRun::look(TimePoint now, Stage& stage) {
  const pus::ScriptLine& line = script_->lines[next_];
  if (seen_ && line.holds(*seen_)) return end_line();
  if (now >= deadline_)
    return fail("not within " + text_of(line.seconds) +
                " s: " + (seen_ ? "it is " + text_of(*seen_) : "nobody answered"));
  if (open_ || now < next_look_) return;
  next_look_ = now + between_looks;
  const auto asked = stage.ask(next_);
  if (asked) open_ = *asked;
  else if (asked.error().code != ErrorCode::ResourceExhausted) fail(asked.error().text);
}

void ScriptRun::hear(const RequestReport& report, TimePoint now, Stage& stage) {
  if (!active() || open_ != report.request) return;
  const bool until = script_->lines[next_].kind == Kind::Until;
  if (until && report.stage == RequestStage::Answered) {
    seen_ = stage.number_in(next_, report.data);
    if (!seen_) return fail("what was answered is no number");
  }
  if (!report.is_end()) return;
  open_.reset();
  if (report.stage != RequestStage::Completed) {
    std::string why{report.reason};
    if (report.number != 0) why += " " + std::to_string(report.number);
    return fail(why);
  }
  if (!until) end_line();
  step(now, stage);
}

void ScriptRun::end_line() noexcept {
  ++next_;
  phase_ = Phase::Between;
  open_.reset();
}

void ScriptRun::fail(const std::string& why) {
  const pus::ScriptLine& line = script_->lines[next_];
  std::string what = "line " + std::to_string(line.number) + ": ";
  if (line.kind != Kind::Wait) what += line.subsystem + " " + line.name + ": ";
  stop(Progress::Failed, what + why);
}

void ScriptRun::stop(Progress how, std::string why) {
  if (!active()) return;
  progress_ = how;
  held_ = false;
  open_.reset();
  why_ = std::move(why);
}

}  // namespace hirosco::script_player
