// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/device_answers.hpp"

#include <cmath>
#include <string_view>

namespace hirosco::simulation {
namespace {

constexpr std::size_t most_delayed_frames = 2048;  // 1 s at 2 kHz

Duration milliseconds_of(double ms) noexcept { return Duration{std::llround(ms * 1e6)}; }

}  // namespace

DeviceAnswers::DeviceAnswers() : delayed_(most_delayed_frames) {}

void DeviceAnswers::measured(const DeviceStatus& status) noexcept {
  const auto written = write_status(last_.octets, status);
  last_.size = written ? written->size() : 0;
}

void DeviceAnswers::answer(TimePoint now) noexcept {
  if (silent(now) || delayed_count_ == delayed_.size()) return;
  Frame& frame = delayed_[(delayed_first_ + delayed_count_) % delayed_.size()];
  frame = last_;
  frame.due = now + delay_;
  ++delayed_count_;
}

void DeviceAnswers::send_due(TimePoint now, DataFlow* flow) noexcept {
  while (delayed_count_ > 0 && delayed_[delayed_first_].due <= now) {
    Frame& frame = delayed_[delayed_first_];
    if (corrupt_frames_ > 0) {
      --corrupt_frames_;
      frame.octets[frame.size / 2] ^= std::byte{0x40};
    }
    // Nobody listening is no matter of a device's.
    if (flow != nullptr && !silent(now)) (void)flow->send(Octets{frame.octets}.first(frame.size));
    delayed_first_ = (delayed_first_ + 1) % delayed_.size();
    --delayed_count_;
  }
}

void DeviceAnswers::forget() noexcept {
  last_.size = 0;
  drop();
}

Result<> DeviceAnswers::fault(const Words& words, TimePoint now) noexcept {
  const std::string_view what = words[0];
  HIROSCO_TRY(words.expect(2));
  if (what == "corrupt") {
    HIROSCO_TRY_LET(const double frames, words.number(1, 0, 1e9));
    corrupt_frames_ = static_cast<std::uint32_t>(frames);
    return ok();
  }
  const double longest_ms = what == "delay" ? 500 : 3'600'000;
  HIROSCO_TRY_LET(const double ms, words.number(1, 0, longest_ms));
  if (what == "stall") silent_until_ = now + milliseconds_of(ms);
  if (what == "freeze") frozen_until_ = now + milliseconds_of(ms);
  if (what == "delay") delay_ = milliseconds_of(ms);
  return ok();
}

void DeviceAnswers::heal() noexcept {
  silent_until_ = frozen_until_ = {};
  delay_ = {};
  corrupt_frames_ = 0;
}

}  // namespace hirosco::simulation
