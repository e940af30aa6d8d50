// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/service/arguments.hpp"
#include "hirosco/subsystem/author/request_port.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What a subsystem has asked of others and not heard the end of. Each request ends once: by a report, or because none came
/// in its time. What it takes from the heap it takes when a request is bound (adr 0220).  Thread: the service loop.
class Requester {
 public:
  /// More of one subsystem are not under way at once, nor sent in one second: the supervisor refuses them (adr 0062).
  static constexpr std::size_t most_open = 16;
  static constexpr std::size_t most_a_second = 100;
  /// Requests are counted from here on, and what is asked to be heard (Subscriber) below: both go to the supervisor, and a report tells them
  /// apart by their count alone.
  static constexpr std::uint16_t first_count = pus::sequence_counts / 2;

  Requester(const descriptor::SubsystemDescriptor& described, Channel& channel, TimePoint now);

  /// Binds a request. What is wrong with it in words; empty when nothing is.
  [[nodiscard]] std::string use(const RequestPort& port, RequestHandler handler, Duration patience);
  /// Sends one, and returns its number. `known_stop`: PermitPage::newest_stop before whatever it is said for was read. NotPermitted: it is not bound; ResourceExhausted: too many are under way, or the
  /// supervisor is behind; of the values, what the encoder of ST[08] says.  Realtime: bounded.
  [[nodiscard]] Result<std::uint32_t> send(const RequestPort& port, pus::GivenValues values, TimePoint now,
                                           std::uint32_t known_stop);
  [[nodiscard]] bool waits() const noexcept { return !open_.empty(); }
  /// A report that came for this subsystem.
  void hear(const pus::TelemetryView& report);
  /// Ends those that nobody answered in their time.
  void step(TimePoint now);
  /// Ends all, and unbinds what was bound.
  void forget();

 private:
  struct Bound;
  [[nodiscard]] std::string bind_function(const RequestPort& port, const descriptor::Commands& commands,
                                          Bound& bound) const;
  [[nodiscard]] std::string bind_thing(const RequestPort& port, const descriptor::Commands& commands,
                                       Bound& bound) const;
  struct Bound {
    const RequestPort* port{nullptr};
    std::uint16_t apid{0};
    descriptor::Function function{};
    std::vector<std::byte> before{};  ///< its arguments, of a framework's service: how many, and which
    RequestHandler handler;
    Duration patience{};
  };
  struct Open {
    std::uint32_t id{0};
    const Bound* bound{nullptr};
    TimePoint deadline{};
  };
  void hear_verification(const pus::TelemetryView& report);
  void hear_answer(const pus::TelemetryView& report);
  void end(std::size_t place, RequestReport report);

  const descriptor::SubsystemDescriptor& descriptor_;
  Channel& channel_;
  std::deque<Bound> bound_;  ///< those of open requests stay where they are
  std::vector<Open> open_;  ///< the oldest first; there is room for all that may be
  std::uint16_t next_count_;
  TimePoint window_{};
  std::size_t sent_in_window_{0};
};

}  // namespace hirosco
