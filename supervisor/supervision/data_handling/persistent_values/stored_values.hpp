// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "supervisor/platform/storage/value_store.hpp"
#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/persistent_values/awaited_changes.hpp"
#include "supervisor/supervision/data_handling/persistent_values/found_values.hpp"
#include "supervisor/supervision/data_handling/persistent_values/value_set.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// Has what telecommands set of persistent parameters outlive the flight (docs/adr/0087). What TC[20,3] sets is known from its TM[1,7]; what
/// a function makes of a parameter that an argument of it is `of` is asked for by TC[20,1] when it has ended. From a change on the subsystem
/// begins with it; VALUES_KEPT is told when the disk has it. Telecommands that have no room among AwaitedChanges, or ask for no report of
/// their end, are asked for like functions. What is under way when a supervisor dies the next one ends (docs/adr/0168).
/// Thread: the supervisor's.
class StoredValues final : public Hearer, public Watch, public Remembered {
 public:
  /// A disk that did not take them is tried again after so long.
  static constexpr Duration retry_after = std::chrono::seconds{10};

  /// Null: nothing outlives the flight, as nobody keeps anything.
  StoredValues(Craft& craft, OwnSubsystem& own, CommandDesk& desk, ValueStore* store)
      : craft_{craft}, own_{own}, desk_{desk}, store_{store}, news_{craft, own} {}

  /// Before any subsystem is started, or when those that run were taken over: each begins with what its copies have, if one is whole and
  /// fits, and goes on with what was recalled.  Realtime: blocks.
  void begin();
  /// It has left for a member.
  void forwarded(std::uint16_t apid, const pus::TelecommandView& telecommand);
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  void watch(TimePoint now) override;
  /// Another text of its descriptor takes the place of the one in force, and says this before anything was set.
  void redeclared(const descriptor::SubsystemDescriptor& subsystem);
  /// Of a descriptor in force: as it was declared, before anything was set.
  void undo(descriptor::SubsystemDescriptor& subsystem) const;
  /// Its process is gone. What a function had made of a value and nobody could ask for any more is what the descriptor says again.
  void ended(std::uint16_t apid);

  /// What is awaited, what is to be asked for, and what the disk has not taken yet.
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

 private:
  using Ids = AwaitedChanges::Ids;
  struct Subject {
    descriptor::MissionSubsystem* member{};
    ValueSet values;
    std::uint64_t sequence{0};
    OnboardTime since{};
    Ids changed{};  ///< to be asked for at `ask_at`
    TimePoint ask_at{};
    Ids asked{};  ///< under way
    bool waits{false};  ///< for the disk
    bool failing{false};  ///< the disk did not take the newest
    TimePoint retry_at{};
  };
  /// Of the supervisor before.
  struct Left {
    Ids changed{};
    std::optional<ValueCopy> unkept{};
  };
  void begin(std::uint16_t apid, Subject& subject);
  void go_on(Subject& subject, const Left& left);
  void hear_end(std::uint16_t from, const pus::TelemetryView& report);
  void take_write(Subject& subject, Octets data);
  void take_report(Subject& subject, Octets data);
  void ask_later(Subject& subject, const Ids& ids);
  void ask(std::uint16_t apid, Subject& subject);
  void changed(Subject& subject);
  void keep(Subject& subject);
  void take_outcomes(TimePoint now);

  Craft& craft_;
  OwnSubsystem& own_;
  CommandDesk& desk_;
  ValueStore* store_;
  std::map<std::uint16_t, Subject> subjects_;  ///< that have persistent parameters, by APID
  AwaitedChanges awaited_;
  std::map<std::uint16_t, Left> left_;
  FoundValues news_;  ///< of the start
};

}  // namespace hirosco::supervisor
