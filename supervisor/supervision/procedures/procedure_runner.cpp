// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/procedure_runner.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::supervisor {

/// Kept by the answers that are still to come.
struct ProcedureRunner::Run : std::enable_shared_from_this<Run> {
  Run(const Means& with, Procedure what) : means{with}, procedure{std::move(what)} {}

  void fence() const {
    for (const Stage& each : procedure.stages)
      for (const ProcedureStep& step : each)
        if (step.kind->fences != nullptr)
          for (const std::uint16_t apid : step.kind->fences(step, means)) means.craft.guard.fence(apid);
  }

  /// What whoever asks for it knows: its own fences, and all before.
  void count_fences() {
    if (!procedure.knows_of_no_stop) return;
    for (Stage& each : procedure.stages)
      for (ProcedureStep& step : each) step.free_at = means.craft.guard.fences(step.subject);
  }

  void begin_stage() {
    while (stage < procedure.stages.size() && procedure.stages[stage].empty()) ++stage;
    if (stage == procedure.stages.size()) return finish();
    const std::size_t count = procedure.stages[stage].size();
    open.assign(count, true);
    if (procedure.begins) procedure.begins(begun_stages++);
    if (over) return;
    // A step may end before run() returns: answers are matched to their stage.
    const std::size_t begun = stage;
    for (std::size_t i = 0; i < count && !over && stage == begun; ++i) {
      const auto done = [self = shared_from_this(), begun, i](bool success, const std::string& why) {
        if (!self->over && self->stage == begun) self->ended(i, success, why);
      };
      const ProcedureStep& step = procedure.stages[begun][i];
      if (step.kind->run != nullptr) step.kind->run(step, means, done);
      else done(true, {});
    }
  }

  void ended(std::size_t step, bool success, const std::string& why) {
    if (!open[step]) return;
    open[step] = false;
    if (!success) {
      if (end.success) end = {false, name_of(procedure.stages[stage][step], " "), why};
      if (procedure.on_failure == Procedure::OnFailure::Stop) return finish();
    }
    if (std::ranges::find(open, true) != open.end()) return;
    ++stage;
    begin_stage();
  }

  void finish() {
    over = true;
    if (const auto finished = std::exchange(procedure.finished, nullptr)) finished(end);
  }

  [[nodiscard]] std::string name_of(const ProcedureStep& step, std::string_view between) const {
    return means.craft.name_of(step.subject) + std::string{between} + text_of(step, means.craft.mission);
  }

  Means means;
  Procedure procedure;
  std::size_t stage{0};
  std::size_t begun_stages{0};
  std::vector<bool> open{};  ///< of the stage: those that have not ended
  ProcedureEnd end{};
  bool over{false};
};

void ProcedureRunner::start(Procedure procedure) {
  cancel();
  const auto run = std::make_shared<Run>(means_, std::move(procedure));
  run_ = run;  // its end may start another here
  run->fence();
  run->count_fences();
  run->begin_stage();
}

void ProcedureRunner::cancel() {
  if (const auto run = run_.lock()) run->over = true;
  run_.reset();
}

bool ProcedureRunner::running() const noexcept {
  const auto run = run_.lock();
  return run && !run->over;
}

void ProcedureRunner::knows_of(std::uint16_t apid, std::uint64_t fences) {
  const auto run = run_.lock();
  if (!run) return;
  for (Stage& each : run->procedure.stages)
    for (ProcedureStep& step : each)
      if (step.subject == apid && step.free_at && *step.free_at + 1 == fences) step.free_at = fences;
}

std::string ProcedureRunner::waiting_for() const {
  std::string text;
  const auto run = run_.lock();
  if (!run || run->over) return text;
  for (std::size_t i = 0; i < run->open.size(); ++i) {
    if (!run->open[i]) continue;
    if (!text.empty()) text += ", ";
    text += run->name_of(run->procedure.stages[run->stage][i], ": ");
  }
  return text;
}

}  // namespace hirosco::supervisor
