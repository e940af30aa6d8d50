// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::supervisor {

/// What goes to the ground link, in order, however slowly that takes it (docs/adr/0029). Reports wait, and while many of
/// them do, no further telecommand of the ground is to be read: each would bring more. Housekeeping is dropped first, the
/// oldest first, for its next sample says more; what is dropped is counted.
/// Thread: one. Realtime: allocates, never blocks.
class GroundRoute {
 public:
  enum class Kind : std::uint8_t { Report, Housekeeping };
  /// So many are handed to the link in one call; they wait for each other no longer than until the end of a step.
  static constexpr std::size_t together = 32;
  struct Limits {
    std::size_t busy{512};  ///< reports that wait: no telecommand is read
    std::size_t reports_octets{4 << 20};  ///< of reports; more only comes from who talks without being asked
    std::size_t housekeeping{256};  ///< packets
    /// A link that has taken nothing for this long is not waited for with telecommands: it may itself wait for its
    /// own telemetry to be read.
    Duration patience{100ms};
    /// While many wait, whoever brings them, the telecommands of one step are read this often: SAFE_ALL may be among them.
    Duration breath{20ms};
  };
  struct Lost {
    std::uint32_t housekeeping{0};
    std::uint32_t reports{0};
    friend bool operator==(const Lost&, const Lost&) = default;
  };

  GroundRoute() : GroundRoute(Limits{}) {}
  explicit GroundRoute(const Limits& limits) : limits_{limits} {}

  [[nodiscard]] static Kind kind_of(const pus::TelemetryView& packet) noexcept {
    return packet.service() == 3 && packet.subtype() == 25 ? Kind::Housekeeping : Kind::Report;
  }
  /// Takes a packet behind those that wait. It is sent with them: by flush(), or when enough are together.
  void send(Channel& link, Octets packet, Kind kind, TimePoint now);
  /// Before telecommands are read.
  void begin_step(TimePoint now) noexcept;
  /// Sends what waits, as much as the link takes.
  void flush(Channel& link, TimePoint now);
  /// Nobody is there: what waits is in the log only, and counted as lost.
  void clear() noexcept;

  [[nodiscard]] bool waiting() const noexcept { return !reports_.empty() || !housekeeping_.empty(); }
  /// Whether the link did not take all that it was given last: what waits now is more than a step has said.
  [[nodiscard]] bool behind() const noexcept { return behind_; }
  /// Whether a telecommand of the ground may be read now.
  [[nodiscard]] bool takes_telecommands(TimePoint now) const noexcept {
    return reports_.size() < limits_.busy || now - moved_ >= limits_.patience || now == breath_;
  }
  [[nodiscard]] const Lost& lost() const noexcept { return lost_; }

 private:
  struct Packet {
    std::uint64_t order{};
    std::vector<std::byte> octets;
  };
  void keep(Octets packet, Kind kind);
  void drop(std::deque<Packet>& queue);
  /// Views of those that are next in order; how many.
  std::size_t next(std::span<Message, together> messages) const;
  void drop_sent(std::size_t count);

  Limits limits_;
  std::deque<Packet> reports_;
  std::deque<Packet> housekeeping_;
  std::vector<std::vector<std::byte>> spare_;  ///< room of packets that have left, for the next ones
  std::size_t reports_octets_{0};
  std::uint64_t order_{0};
  std::optional<TimePoint> breath_;  ///< the step that reads telecommands although many wait
  TimePoint next_breath_{};
  TimePoint moved_{};  ///< when the link took something last, or had nothing to take
  bool behind_{false};
  Lost lost_{};
};

}  // namespace hirosco::supervisor
