// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/sequence.hpp"

#include <utility>

namespace hirosco::supervisor {

void Sequence::start(std::vector<Stage> stages, OnFailure on_failure, Finished finished) {
  ++run_;
  stages_ = std::move(stages);
  stage_ = 0;
  on_failure_ = on_failure;
  finished_ = std::move(finished);
  first_failure_.clear();
  running_ = true;
  begin_stage();
}

void Sequence::cancel() {
  ++run_;
  running_ = false;
  open_.clear();
  open_count_ = 0;
}

void Sequence::begin_stage() {
  while (stage_ < stages_.size() && stages_[stage_].empty()) ++stage_;
  if (stage_ == stages_.size()) return finish(first_failure_.empty(), first_failure_);
  const std::size_t count = stages_[stage_].size();
  open_.assign(count, true);
  open_count_ = count;
  // A command may end before command() returns: answers are matched to this run and stage.
  const std::uint32_t run = run_;
  const std::size_t stage = stage_;
  for (std::size_t i = 0; i < count && run == run_ && stage == stage_; ++i) {
    const Command& next = stages_[stage][i];
    desk_.command(next.apid, next.function, next.argument, [this, run, stage, i](bool success, const std::string& why) {
      if (run == run_ && stage == stage_) ended(i, success, why);
    });
  }
}

void Sequence::ended(std::size_t command, bool success, const std::string& why) {
  if (!open_[command]) return;
  open_[command] = false;
  --open_count_;
  if (!success) {
    const Command& failed = stages_[stage_][command];
    const std::string text = failed.subsystem + " " + failed.text + ": " + why;
    if (first_failure_.empty()) first_failure_ = text;
    if (on_failure_ == OnFailure::Stop) return finish(false, text);
  }
  if (open_count_ != 0) return;
  ++stage_;
  begin_stage();
}

void Sequence::finish(bool success, const std::string& why) {
  ++run_;
  running_ = false;
  open_count_ = 0;
  if (const auto finished = std::exchange(finished_, nullptr)) finished(success, why);
}

std::string Sequence::waiting_for() const {
  std::string text;
  if (!running_ || stage_ >= stages_.size()) return text;
  for (std::size_t i = 0; i < open_.size(); ++i) {
    if (!open_[i]) continue;
    if (!text.empty()) text += ", ";
    text += stages_[stage_][i].subsystem + ": " + stages_[stage_][i].text;
  }
  return text;
}

}  // namespace hirosco::supervisor
