// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/subsystem_handling/version_notes.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

class Processes;
class Reactions;
class UnderWay;
class VersionTexts;

/// Puts another version of a subsystem's executable in its place while the others cycle (docs/adr/0089): in Offline, on trial, and
/// back to the one before by itself unless it is confirmed in time. Where its descriptor says more by then, that text comes with it and
/// goes with it (docs/adr/0214).  Thread: the supervisor's.
class Replacement final : public Watch, public Remembered {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    Processes& processes;
    Reactions& reactions;
    const UnderWay& under_way;
    VersionTexts& texts;
  };
  /// What a process in Offline may take to end, and what a version that was not confirmed may take to get there: then it is ended.
  static constexpr Duration longest_end = 1s;
  static constexpr Duration longest_way_down = 10s;
  /// What a file may take to be read.
  static constexpr Duration longest_reading = 60s;

  explicit Replacement(const Parts& parts) : parts_{parts}, craft_{parts.craft} {}

  /// REPLACE, CONFIRM, TAKE_BACK.
  void provide();
  [[nodiscard]] Outcome replace(std::uint16_t apid, std::string_view version, Duration within, const Call& call);
  [[nodiscard]] Outcome confirm(std::uint16_t apid);
  [[nodiscard]] Outcome take_back(std::uint16_t apid, const Call& call);
  /// Its process has ended by itself: before anybody starts it again.
  void died(std::uint16_t apid);
  void watch(TimePoint now) override;
  /// Which are in force, and those on trial: these go back in the next supervisor, which nobody has told how they did.
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

 private:
  enum class Phase : std::uint8_t {
    Reading,  ///< program and descriptor, by another thread
    Ending,  ///< the process of the version before
    Starting,  ///< its text is in force, and noted before a process flies by it
    OnTrial,  ///< it runs and is not confirmed
    GoingDown,  ///< it was not: on its way to Offline
  };
  struct Change {
    Phase phase{Phase::Reading};
    std::string wanted;  ///< empty: the mission's own executable
    std::string before;  ///< what it falls back to
    bool trial{true};  ///< false: it goes back
    Duration within{};
    TimePoint deadline{};
    std::uint32_t process{0};  ///< that is to end
    std::optional<Call> call{};  ///< that waits for it
    void go_back() noexcept {
      wanted.swap(before);
      trial = false;
    }
  };
  /// True: it is over.
  [[nodiscard]] bool step(Member& subject, Change& change, TimePoint now);
  [[nodiscard]] bool read(Member& subject, Change& change, TimePoint now);
  [[nodiscard]] bool exchange(Member& subject, Change& change, TimePoint now);
  [[nodiscard]] bool start(Member& subject, Change& change, TimePoint now);
  [[nodiscard]] bool bring_down(Member& subject, Change& change, TimePoint now);
  void end_process(Member& subject, Change& change);
  void finish(Change& change);
  void give_up(Change& change, pus::FailureCode code, const char* words, std::int64_t number = 0);
  /// A change is over: the version `left` is dropped unless it may be gone back to, and so is each text.
  void settle(Member& subject, const std::string& left);

  Parts parts_;
  Craft& craft_;
  std::map<std::uint16_t, Change> changes_;
  Versions in_force_;  ///< where it is not the mission's own
  Versions earlier_;  ///< confirmed away
};

}  // namespace hirosco::supervisor
