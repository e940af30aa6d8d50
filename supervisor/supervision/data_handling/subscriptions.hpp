// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>

#include "hirosco/pus/service/service.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/deliveries.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// Housekeeping and events of one subsystem, passed on to those that hear them (adr 0098). Who may hear what is permission's; this
/// keeps who does: until it says otherwise or its process ends. Whose reports they are does not know of it, and may die and come
/// back. An event comes whether its report to the ground is switched on or not. More than it may have in a second, or than its
/// channel and a few places hold, is lost to it alone, counted and told. Who was told that it hears goes on hearing when another
/// supervisor goes on (docs/adr/0168).  Thread: the supervisor's.
class Subscriptions final : public Hearer, public Watch, public Remembered {
 public:
  static constexpr std::size_t most_a_second = 200;  ///< reports for one subscriber
  /// Of all subscribers together: what the journal has room for beside everything else.
  static constexpr std::size_t most_heard = 8192;

  Subscriptions(Craft& craft, OwnSubsystem& own);

  /// TC[129,8] and [129,9]: whoever asks was found to be permitted.
  void begin(const pus::Request& asked, Octets data) { answer(asked, data, true); }
  void end(const pus::Request& asked, Octets data) { answer(asked, data, false); }
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  /// An event of a member, as it came from it.
  void hear_event(std::uint16_t from, Octets message);
  void watch(TimePoint now) override;

  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;
  /// What was recalled is of the processes that this supervisor has taken over, and of nobody who is started later.
  void go_on();

 private:
  struct Subscriber {
    std::uint32_t process{0};
    std::set<pus::st129::Subscribed> heard{};
    TimePoint window{};
    std::size_t in_window{0};
  };
  void answer(const pus::Request& asked, Octets data, bool begins);
  [[nodiscard]] std::size_t heard() const;
  /// Each who hears it, with room for one more in this second.
  template <class Give>
  void each_of(const pus::st129::Subscribed& what, Give&& give);

  Craft& craft_;
  OwnSubsystem& own_;
  Deliveries deliveries_;
  std::map<std::uint16_t, Subscriber> subscribers_;
  std::uint16_t events_{0};  ///< that were passed on: their sequence count
};

}  // namespace hirosco::supervisor
