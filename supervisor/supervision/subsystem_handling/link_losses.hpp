// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// What the mission says of a link whose set is lost to its consumer (docs/adr/0077): it goes on for a while, or without it, or in another
/// configuration. None of it lets anybody move: the cycle's own inhibit, and the guard, are not asked. Thread: the supervisor's.
class LinkLosses final : public Watch, public Undertaking, public LossHandling, public Remembered {
 public:
  LinkLosses(const Means& means, OwnSubsystem& own) : means_{means}, craft_{means.craft}, own_{own} {}

  void lost(std::uint8_t link) override;
  bool answers(std::uint16_t apid, std::string_view event) override;
  [[nodiscard]] std::uint8_t answered_link(std::uint16_t apid, std::string_view event) const override;
  /// Those that are held over, and those on their way to another configuration.
  void watch(TimePoint now) override;
  Cancelled cancel(std::string_view why) override;
  void all_stopped(std::string_view why) override { static_cast<void>(cancel(why)); }
  /// Whoever the supervisor before this one led to another configuration goes there and rests, or goes down; told either way.
  void end_what_was_begun();
  /// Somebody is on its way to another configuration.
  [[nodiscard]] bool leads(std::uint16_t apid) const;
  /// What is held over, and until when: its time goes on while no supervisor is there. And whoever is led to another configuration.
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

 private:
  struct Fallback {
    explicit Fallback(const Means& means) : runner{means} {}
    ProcedureRunner runner;
    std::uint64_t fences{0};  ///< when it began
    std::uint8_t link{0};  ///< that was lost
    bool begins{false};  ///< it is about to be run
  };
  enum class Begun : std::uint8_t { Now, Before };
  [[nodiscard]] Member& consumer_of(const descriptor::MissionLink& link);
  void fall_back(const descriptor::MissionLink& link, Member& consumer);
  /// Its consumer to the configuration for its loss and this state, unless it is fenced once more meanwhile.
  void lead_there(const descriptor::MissionLink& link, std::uint64_t own_fence, State to, Begun begun);
  /// False: its consumer is between two states, and cannot be led yet.
  bool goes_to_rest(const descriptor::MissionLink& link);
  /// What the consumer makes of the set, by whichever link it comes, as its own page says: whatever samples travel by, and whoever
  /// made the link. Of a set without a link that is up: not judged.
  [[nodiscard]] std::uint32_t judgement_of(const descriptor::MissionLink& link);
  /// The consumer has its set again, from somebody who is not on his way down.
  [[nodiscard]] bool is_back(const descriptor::MissionLink& link);
  /// Whom it drives acts without it, however that came about.
  [[nodiscard]] bool is_missed(const descriptor::MissionLink& link);
  [[nodiscard]] bool is_needed(const descriptor::MissionLink& link);
  [[nodiscard]] bool is_made_anew(const descriptor::MissionLink& link);
  void held_long_enough(const descriptor::MissionLink& link);
  void bring_down(const descriptor::MissionLink& link, const std::string& why);

  Means means_;
  Craft& craft_;
  OwnSubsystem& own_;
  std::map<std::uint8_t, TimePoint> holds_;  ///< until when, by link; of what is ignored without an end
  std::map<std::uint16_t, Fallback> fallbacks_;  ///< that run, by consumer
  std::set<std::uint8_t> begun_before_;  ///< links whose consumer the supervisor before was leading
  bool ends_what_was_begun_{false};  ///< by that one: this one can command
};

}  // namespace hirosco::supervisor
