// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/sample_time.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::robot_arm {
namespace {

constexpr Duration counted_for = 500ms;

}  // namespace

void SampleTime::update(TimePoint planned, Duration period, bool begins, bool fresh) noexcept {
  if (begins) {
    last_ = planned - period;
    counts_from_ = planned;
    missed_ = {};
    heard_ = false;
  }
  const Duration since = planned - last_;
  // Cycles that samples start come sooner than their period, and miss none.
  periods_ = static_cast<std::uint32_t>(std::max<std::int64_t>(1, since / period));
  count_missed(planned);
  between_ = {};
  if (fresh) {
    // Of the first one nobody knows more.
    const bool first = !std::exchange(heard_, true);
    between_ = {.s = seconds(first ? period : last_ - sampled_), .unsure = periods_ > 1};
    sampled_ = last_;
  }
  last_ = planned;
}

void SampleTime::count_missed(TimePoint planned) noexcept {
  const Duration since = planned - counts_from_;
  if (since >= counted_for) {
    missed_ = {0, since < 2 * counted_for ? missed_[0] : 0};
    counts_from_ = planned;
  }
  missed_[0] += periods_ - 1;
}

}  // namespace hirosco::robot_arm
