// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "simulation/devices/words.hpp"

namespace hirosco::simulation {

/// What a simulated device says at the endnode that drives it: its newest status frame, on its way for as long as it was made to be late,
/// and whatever else can be wrong with it.
/// Realtime: bounded, no allocation once it is made. Thread: one.
class DeviceAnswers {
 public:
  DeviceAnswers();

  /// Whether the next answer takes a measurement of its own: it is frozen to the last one otherwise.
  [[nodiscard]] bool measures(TimePoint now) const noexcept { return now >= frozen_until_ || last_.size == 0; }
  void measured(const DeviceStatus& status) noexcept;
  /// The last measurement is on its way; it is lost while the device is silent, or where too many are.
  void answer(TimePoint now) noexcept;
  /// Says what is due by now; into nothing where `flow` is null.
  void send_due(TimePoint now, DataFlow* flow) noexcept;
  /// When the next one is due; the end of time where none is on its way.
  [[nodiscard]] TimePoint next_due() const noexcept {
    return delayed_count_ > 0 ? delayed_[delayed_first_].due : TimePoint::max();
  }
  /// What is on its way is lost.
  void drop() noexcept { delayed_count_ = 0; }
  /// It has had no power: it knows nothing of what was before.
  void forget() noexcept;

  [[nodiscard]] bool silent(TimePoint now) const noexcept { return now < silent_until_; }
  /// It says nothing any more until it is healed.
  void fall_silent() noexcept { silent_until_ = TimePoint::max(); }
  /// stall MS | freeze MS | delay MS | corrupt N, from `now` on. InvalidArgument, OutOfRange: nothing was done.
  [[nodiscard]] Result<> fault(const Words& words, TimePoint now) noexcept;
  void heal() noexcept;

 private:
  struct Frame {
    std::array<std::byte, max_device_frame_octets> octets;
    std::size_t size{0};
    TimePoint due{};
  };

  TimePoint silent_until_{};
  TimePoint frozen_until_{};
  Duration delay_{0};
  std::uint32_t corrupt_frames_{0};
  Frame last_{};
  std::vector<Frame> delayed_;  // ring, sized once
  std::size_t delayed_first_{0};
  std::size_t delayed_count_{0};
};

}  // namespace hirosco::simulation
