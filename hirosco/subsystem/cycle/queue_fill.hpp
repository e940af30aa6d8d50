// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "hirosco/descriptor/model/resources.hpp"

namespace hirosco {

/// How full a queue was at most, and how much it holds: commands, requests or octets.
struct QueueFill {
  std::uint32_t most{0};
  std::uint32_t room{0};  ///< 0: there is no such queue
  /// Of what it holds, rounded up: 0 only where nothing was in it.
  [[nodiscard]] constexpr std::uint8_t percent() const noexcept {
    constexpr std::uint64_t whole = 100;
    if (room == 0) return 0;
    return static_cast<std::uint8_t>(std::min<std::uint64_t>((most * whole + room - 1) / room, whole));
  }
};
/// By place_of().
using QueueFills = std::array<QueueFill, descriptor::queues_of_subsystem>;
[[nodiscard]] constexpr std::size_t place_of(descriptor::Resource queue) noexcept {
  return static_cast<std::size_t>(queue) - static_cast<std::size_t>(descriptor::Resource::CycleCommands);
}

/// The most that was in a queue at once since take() was asked last. One that refused something was full to whoever asked, however
/// much of it others may still have.  Thread: the service loop, which is at one end of each.
class FillMark {
 public:
  void note(std::uint64_t used, std::uint64_t lost, std::uint64_t room) noexcept {
    most_ = std::max(most_, std::exchange(lost_, lost) != lost ? room : used);
  }
  [[nodiscard]] std::uint32_t take() noexcept { return static_cast<std::uint32_t>(std::exchange(most_, 0)); }

 private:
  std::uint64_t most_{0};
  std::uint64_t lost_{0};
};

}  // namespace hirosco
