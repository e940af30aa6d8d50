// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "ground/archive/archive.hpp"
#include "ground/model/model.hpp"

namespace hirosco::ground {

/// The past as one page looks at it: a model of its own, fed with the archive's packets as they came, at its own speed.
class Replay {
 public:
  /// A message of what happened then.
  using Tell = std::function<void(nlohmann::json message)>;

  /// Begins with the newest reports before `at`, which is brought within the archive. `catalogue` and `archive` outlive it.
  Replay(const Catalogue& catalogue, Archive& archive, const Span& extent, OnboardTime at, double speed, TimePoint now);

  /// Goes on by the time that has passed.
  void play(TimePoint now, const Tell& tell);
  /// Time passes, the past waits.
  void wait(TimePoint now) noexcept { last_ = now; }

  [[nodiscard]] const Model& model() const noexcept { return model_; }
  [[nodiscard]] OnboardTime at() const noexcept { return at_; }
  [[nodiscard]] double speed() const noexcept { return speed_; }
  [[nodiscard]] bool ended() const noexcept { return ended_; }
  /// "playing", "paused" or "ended".
  [[nodiscard]] const char* state() const noexcept { return ended_ ? "ended" : speed_ == 0.0 ? "paused" : "playing"; }

 private:
  /// Where a step ends: a burst takes several, so that no event is left out and none chokes the page.
  [[nodiscard]] OnboardTime step_end(const Span& span);
  void tell_past(const Span& span, const Tell& tell);

  const Catalogue& catalogue_;
  Archive& archive_;
  Model model_;
  OnboardTime at_;
  OnboardTime end_;
  double speed_;
  bool ended_{false};
  TimePoint last_;
};

}  // namespace hirosco::ground
