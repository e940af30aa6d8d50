// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <set>
#include <string>
#include <vector>

#include "hirosco/utilities/octets.hpp"
#include "supervisor/supervision/event_handling/plan_rank.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"

namespace hirosco::supervisor {

/// A plan about to begin for one member.
struct PlanStart {
  std::uint16_t subject{};
  Occasion occasion{};
  std::uint16_t number{};  ///< of the plan in the mission, from 1; 0 = the default
  std::uint8_t priority{};
  descriptor::Severity severity{};
  Stage steps{};  ///< at least one, taken one after the other
  bool of_loss{false};  ///< whoever is gone is stopped and taken down whatever else runs for it (hazard SF5)
  std::uint16_t origin{};  ///< whose event it answers
  Stage planned{};  ///< all for its subject, in their order; those that have nothing to do now are none of `steps`
  bool anew{false};  ///< a supervisor before this one had begun it and died over it
};

/// A plan that is under way for a member, as far as whoever goes on for this supervisor has to know of it: what it answers.
struct PlanUnderWay {
  std::uint16_t subject{};
  std::uint16_t origin{};
  descriptor::Severity severity{};
  bool anew{false};
  std::string event{};
  /// As it stands in the journal. What a reader that is no longer good has given is nothing.
  void note(OctetWriter& writer) const;
  void recall(OctetReader& reader);
};

/// The plans that run, and which gives way to which (docs/adr/0090): one at a time for a member, and beside it only what answers its
/// loss. One that gives way is over: its outstanding steps are not taken, what it has fenced stays fenced, what it was told to
/// lower stays lowered. One that may not begin is refused: later it would act on what has changed since. Bounded: for each member one, and
/// one for each plan and event of its loss. Thread: the supervisor's.
class PlanRuns {
 public:
  /// In the place of a plan, where it gave way to the loss of a link.
  static constexpr std::uint16_t loss_of_a_link = 65'535;
  using Failed = std::function<void(const PlanStart&, const ProcedureEnd&)>;

  /// `failed`: of a member that lives and a plan that nothing has pre-empted.
  PlanRuns(const Means& means, OwnSubsystem& own, Failed failed)
      : means_{means}, own_{own}, failed_{std::move(failed)} {}

  void begin(const PlanStart& plan);
  /// Why begin() would refuse it now, in words; empty: it would not.
  [[nodiscard]] std::string against(const PlanStart& plan) const;
  /// Those that hold their subject, unless somebody else takes that down.
  [[nodiscard]] std::vector<PlanUnderWay> under_way() const;

 private:
  struct Run {
    Run(const Means& means, PlanStart what) : runner{means}, plan{std::move(what)} {}
    [[nodiscard]] PlanRank rank() const;
    ProcedureRunner runner;
    PlanStart plan;
    std::size_t at{0};  ///< the step that is taken now
    mutable std::set<std::uint16_t> refused{};  ///< plans that were told of it
  };
  /// False: it may not begin.
  [[nodiscard]] bool makes_way(const PlanStart& plan);
  /// That runs for its subject and does not give way.
  [[nodiscard]] std::list<Run>::const_iterator in_its_way(const PlanStart& plan) const;
  void cancel(Run& run);
  void give_up(Run& run, std::uint16_t by, const std::string& name);
  /// Whoever goes down with this one's network follows no plan of its own any more.
  void give_up_those_down(const Run& by);
  /// Somebody else has taken its subject down, and it goes there without this one's help.
  [[nodiscard]] bool is_overtaken(const Run& run) const;
  void step_begins(Run& run, std::size_t step);
  void ended(Run& run, const ProcedureEnd& end);
  [[nodiscard]] MemberRecovery& recovery_of(std::uint16_t apid) { return means_.craft.member(apid)->recovery; }

  Means means_;
  OwnSubsystem& own_;
  Failed failed_;
  std::list<Run> runs_;
};

}  // namespace hirosco::supervisor
