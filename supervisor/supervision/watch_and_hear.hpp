// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/time.hpp"

/// How the parts of the supervisor are met by what happens. A new part implements what it needs of these and is named once,
/// in composition.hpp.
namespace hirosco::supervisor {

using pus::supervisor_apid;

/// Looks after something: called in every watch period of the supervisor.
class Watch {
 public:
  virtual ~Watch() = default;
  virtual void watch(TimePoint now) = 0;
};

/// Hears every report that comes by, after it was logged and routed.
class Hearer {
 public:
  virtual ~Hearer() = default;
  virtual void hear(std::uint16_t from, const pus::TelemetryView& report) = 0;
};

/// Keeps what telecommands are under way, and says how they end when nobody else will.
class Accounts {
 public:
  virtual ~Accounts() = default;
  /// Nothing of what waits for the disk leaves any more.
  virtual void refuse_waiting() = 0;
  /// Who is gone will never report what it had begun.
  virtual void outcome_unknown(std::uint16_t apid) = 0;
};

/// What a cancel has ended.
enum class Cancelled : std::uint8_t {
  Nothing,  ///< it was over already, or the shutdown has taken over
  Ended,  ///< the flight goes on without it
  ForGood,  ///< the commissioning, which nobody begins again: the flight has failed
};

/// What takes many steps and goes on by itself: it would go on with what was taken down or stopped as if nothing had happened.
class Undertaking {
 public:
  virtual ~Undertaking() = default;
  /// For a recovery.
  virtual Cancelled cancel(std::string_view why) = 0;
  /// Every actuator is stopped, and whoever did it takes the states along.
  virtual void all_stopped(std::string_view why) = 0;
};

/// What a way into a mode does with a member.
enum class Moving : std::uint8_t {
  No,  ///< it leaves it where it is
  ToItsStop,  ///< it is about to take it out of Operational
  Beyond,  ///< it has done so, or found it elsewhere, and leads it on
};

/// What brings the craft into a mode.
class WayIntoMode : public Undertaking {
 public:
  [[nodiscard]] virtual Moving moving(std::uint16_t apid) const = 0;
  /// Whom it is about to take out of Operational may not act until then: it is fenced at once, and the undertaking, which knows of that, goes on.
  virtual void stop_now(std::uint16_t apid) = 0;
};

/// What the mission says of the loss of a link, done (docs/adr/0077).
class LossHandling {
 public:
  virtual ~LossHandling() = default;
  /// The producer of this link goes down, and its consumer does not.
  virtual void lost(std::uint8_t link) = 0;
  /// True: this event of a member tells of a link whose loss is answered here, by no plan.
  virtual bool answers(std::uint16_t apid, std::string_view event) = 0;
  /// Which link that is, without answering; 0: none.
  [[nodiscard]] virtual std::uint8_t answered_link(std::uint16_t apid, std::string_view event) const = 0;
};

}  // namespace hirosco::supervisor
