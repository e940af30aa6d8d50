// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <vector>

#include "hirosco/utilities/octets.hpp"
#include "supervisor/supervision/craft.hpp"

namespace hirosco::supervisor {

/// Packets on their way to members that do not always read: a few wait for each; what is beyond is lost to that member alone,
/// counted and told once a second.  Thread: the supervisor's.
class Deliveries {
 public:
  static constexpr std::size_t most_waiting = 256;  ///< packets for one member
  /// Told of a member and how many it has lost since it was told last.
  using Lost = std::function<void(const Member&, std::uint32_t)>;

  Deliveries(Craft& craft, Lost lost) : craft_{craft}, lost_{std::move(lost)} {}

  /// The member is alive.
  void give(const Member& member, Octets packet);
  /// It is lost before it could wait.
  void lose(const Member& member) { ++queue_of(member).lost; }
  void watch(TimePoint now);

 private:
  struct Queue {
    std::uint32_t process{0};  ///< whose it is: one that was started anew has asked for nothing
    std::deque<std::vector<std::byte>> waiting{};
    std::uint32_t lost{0};
    std::uint32_t lost_told{0};
    TimePoint next_told{};
  };
  [[nodiscard]] Queue& queue_of(const Member& member);
  static void flush(const Member& member, Queue& queue);

  Craft& craft_;
  Lost lost_;
  std::map<std::uint16_t, Queue> queues_;
};

}  // namespace hirosco::supervisor
