// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/time.hpp"

/// Telecommands that were handed to a subsystem and whose final report has not passed yet: when their addressee dies,
/// somebody must say that their outcome is unknown (docs/adr/0062).
namespace hirosco::supervisor {

class Unanswered {
 public:
  /// To all subsystems at once. Whoever forwards one more asks full() before.
  static constexpr std::size_t most = 16'384;

  /// A telecommand leaves for `apid`. One that asks for no report on its completion is known until it was accepted, or
  /// until its acceptance would not be told either, for nobody waits for more.
  void forwarded(std::uint16_t apid, const pus::TelecommandView& telecommand, TimePoint now);
  /// Whether a report that came by answers something that its destination has asked of its sender. Besides the end of a
  /// telecommand a number of reports does, so that an addressee cannot flood who asks.
  static constexpr std::uint16_t most_reports = 64;
  [[nodiscard]] bool answers(const pus::TelemetryView& report);
  /// How many of `source` are under way, but for those that are older than request_patience: it has given them up itself, or waits longer for them
  /// and may have others besides.
  [[nodiscard]] std::size_t count_of(std::uint16_t source, TimePoint now) const;
  /// A report of service 1 came by: what it ends is forgotten.
  void reported(const pus::TelemetryView& report);
  /// All that `apid` was given and did not end; they are forgotten.
  [[nodiscard]] std::vector<pus::Request> take(std::uint16_t apid);
  /// What was told of those that have ended so far has left for the ground.
  void delivered() noexcept { settled_.clear(); }

  // --- beyond this supervisor (docs/adr/0093, 0190) -----------------------------------------------------------------
  /// All that wait, those that may have left, those whose end was heard and has not left yet, and the newest count of each sender's
  /// packets. The supervisor's own requests as long as they wait: nobody does it for them any more, but in the log each has one end.
  void note(OctetWriter& writer) const;
  void recall(OctetReader& reader);
  /// The supervisor before was about to send it, or had: until its addressee says anything of it nobody knows.
  void was_leaving(std::uint16_t apid, const pus::Request& request);
  /// What members say is read from now on.
  void hears_from(TimePoint now) noexcept { hears_from_ = now; }
  /// Of those recalled: whose end was heard by a supervisor that died before it could be told. They are forgotten.
  [[nodiscard]] std::vector<pus::Request> take_settled();
  /// Packet `count` of this sender came by. Where some before it have not, its ends may be among them.
  void counted(std::uint16_t apid, std::uint16_t count, TimePoint now);
  /// Those recalled whose end may have been lost, when it has not come in `doubt`, and those of which nothing is heard in that time that
  /// may have left: they are forgotten, and what their addressee says of their end later is a contradiction.
  static constexpr Duration doubt = std::chrono::seconds{1};
  [[nodiscard]] std::vector<pus::Request> take_doubtful(TimePoint now);
  /// A report of the end of a telecommand whose end was told already.
  [[nodiscard]] bool contradicts(const pus::TelemetryView& report) const;

  [[nodiscard]] bool full() const noexcept { return entries_.size() >= most; }
  [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }

 private:
  /// What the supervisor before knew of it.
  enum class Before : std::uint8_t {
    Nothing,  ///< it is this one's
    Left,
    Leaving,  ///< or not yet
    Ended,  ///< its end was heard and could not be told
  };
  static constexpr std::array noted{Before::Left, Before::Leaving, Before::Ended};
  struct Entry {
    std::uint16_t apid{0};
    pus::Request request;
    TimePoint since{};
    std::uint16_t reports{0};  ///< that answered it
    Before before{Before::Nothing};
  };
  /// As unknown. They are forgotten.
  template <class Which>
  void take_as_unknown(const Which& which, std::vector<pus::Request>& taken);
  struct Sender {
    std::uint16_t count{0};  ///< of its newest packet
    bool recalled{false};  ///< by the supervisor before
    std::optional<TimePoint> lost_at{};
  };
  static constexpr std::size_t most_told = 256;
  std::optional<TimePoint> hears_from_;  ///< while there may be some that were leaving
  std::vector<Entry> settled_;
  std::map<std::uint16_t, Sender> senders_;
  std::deque<Entry> told_;  ///< as unknown, though their addressee lives
  std::deque<Entry> entries_;  ///< in the order of forwarding; the oldest end first as a rule
};

}  // namespace hirosco::supervisor
