// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "supervisor/guard/guard_findings.hpp"
#include "supervisor/guard/guard_roster.hpp"
#include "supervisor/guard/guard_time.hpp"
#include "supervisor/guard/stop_number.hpp"

namespace hirosco::supervisor {

/// How one actuator, or a member without any, answered the stop of everything.
struct StopAnswer {
  std::uint16_t apid{0};
  std::string name;  ///< of the device, or of the member where it has no actuator
  bool asked_device{false};  ///< the device said it, on the endnode of its second inhibit; else its member did
  std::optional<Duration> stopped;  ///< after the stop was ordered; empty: it did not
  bool killed{false};  ///< its member was ended, as it had not stopped in time
  std::string_view otherwise{};  ///< it has stopped, but not as its descriptor declares: a literal that says so
};

/// The stop of everything: who is fenced, who has answered, who is ended for not stopping, and when it has ended.
/// Thread: under the guard's mutex.
class StopOfAll {
 public:
  struct Parts {
    const Clock& clock;
    GuardRoster& guarded;
    StopNumber& number;
    const GuardTime& time;
    GuardFindings& findings;
  };
  explicit StopOfAll(const Parts& parts) : parts_{parts} {}

  /// Everybody but the spared is fenced. Stops that overlap end together.
  /// \return names this stop; outcome() is asked with it.
  std::uint64_t begin();
  /// The same, of which the supervisor is still to hear.
  std::uint64_t begin(GuardFinding::Kind why);
  [[nodiscard]] bool under_way() const noexcept { return stops_ended_ != stops_; }
  /// Ends who has not stopped in time, and the stop once all have or their time has run out. Only while one is under way.
  /// Realtime: bounded; no heap but for findings.
  void follow(TimePoint now);
  /// False: it is to stop and has not yet. Else it does not hold up this stop any more.
  [[nodiscard]] bool lets_go(GuardedMember& member);
  /// The answers; empty while some are still to stop.
  [[nodiscard]] std::optional<std::vector<StopAnswer>> outcome(std::uint64_t stop) const;

 private:
  Parts parts_;
  std::uint64_t stops_{0};  ///< the newest stop of everything whose outcome may be asked for
  std::uint64_t stops_ended_{0};
};

}  // namespace hirosco::supervisor
