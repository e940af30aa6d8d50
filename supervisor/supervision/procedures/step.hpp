// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/commanded_members.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/procedures/waiting.hpp"
#include "supervisor/supervision/realtime_links/link_graph.hpp"
#include "supervisor/supervision/restart_schedule.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

/// One step of a procedure, and what a kind of step is (docs/adr/0057).
namespace hirosco::supervisor {

/// What steps act with. Thread: the supervisor's.
struct Means {
  Craft& craft;
  CommandDesk& desk;
  const LinkGraph& links;
  Restarts& restarts;
  WayIntoMode& under_way;
  CommandedMembers& commanded;
  LossHandling& losses;
  Waiting& waiting;
};

/// Why a plan runs; empty where none does.
struct Occasion {
  std::string plan;
  std::string event{};  ///< empty: the story has it already
};

/// How far towards safety a step takes its subject. What runs gives way to nothing that does less (docs/adr/0090).
enum class Safety : std::uint8_t {
  None,  ///< it stops nobody
  Stop,  ///< its actuators are fenced
  Network,  ///< and those of all that real-time links join to it, which go down
};

struct StepKind;
struct ProcedureStep {
  const StepKind* kind{nullptr};
  std::uint16_t subject{0};              ///< APID
  std::vector<std::int64_t> values{};    ///< as many as its kind has
  Occasion occasion{};
  std::vector<std::string> words{};      ///< as of descriptor::PlanStep, as the next
  std::vector<double> arguments{};
  /// The guard's count of its subject's fences that is known to whoever asked for it: another one, and its subject was stopped since.
  std::optional<std::uint64_t> free_at{};
};

/// A kind of step: a file in steps/ and a row in step_kinds.hpp.
struct StepKind {
  enum class Holds : std::uint8_t { Subject, Nobody };
  std::string_view name;
  std::size_t values{0};
  /// What it asks of its subject: "Operational", "link 1". Null: it never waits and never fails.
  std::string (*text)(const ProcedureStep&, const descriptor::Mission&){nullptr};
  /// Begins it; `done` is called once, now or later. Null: there is nothing to do.
  void (*run)(const ProcedureStep&, const Means&, CommandDone done){nullptr};
  /// Whose actuators it stops. That may wait for nothing: they are fenced for all steps of a procedure before its first one begins, and
  /// by the guard alone when the system says that the subject's process has ended (docs/adr/0102). Null: nobody's.
  std::vector<std::uint16_t> (*fences)(const ProcedureStep&, const Means&){nullptr};
  /// For plans: whether there is something to do now. Null: always.
  bool (*answers)(const ProcedureStep&, const Craft&){nullptr};
  /// For plans: why it could not be done now, in words; empty: it could. Nothing is done. Null: nothing is ever against it.
  std::string (*against)(const ProcedureStep&, const Means&){nullptr};
  /// For plans: it is about the craft and no subsystem, and done once where a plan is for all.
  bool of_craft{false};
  /// For plans. Null: Safety::None.
  Safety (*safety)(const ProcedureStep&){nullptr};
  /// For plans: whether a lesser event of its subject begins nothing else while it runs.
  Holds holds{Holds::Subject};
};

/// Of a plan: there is something to do now.
[[nodiscard]] inline bool does_something(const ProcedureStep& step, const Craft& craft) {
  return step.kind->answers == nullptr || step.kind->answers(step, craft);
}

/// What it asks of its subject, in words.
[[nodiscard]] inline std::string text_of(const ProcedureStep& step, const descriptor::Mission& mission) {
  return step.kind->text != nullptr ? step.kind->text(step, mission) : std::string{step.kind->name};
}

}  // namespace hirosco::supervisor
