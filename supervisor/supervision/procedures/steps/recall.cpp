// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/steps/recall.hpp"

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace hirosco::supervisor::steps::settings {
namespace {

/// Kept by the answer that is still to come.
struct Sending : std::enable_shared_from_this<Sending> {
  Sending(CommandDesk& through, std::uint16_t whom, std::vector<SettingCommand> what, CommandDone ended)
      : desk{through}, apid{whom}, commands{std::move(what)}, done{std::move(ended)} {}

  void next() {
    if (at == commands.size()) return done(true, {});
    const SettingCommand& command = commands[at++];
    desk.send(
        apid, command.service, command.subtype, command.data, {},
        [self = shared_from_this(), &command](bool success, const std::string& why) {
          if (!success && !self->refused) return self->done(false, why);
          if (!success) self->refused(command);
          self->next();
        },
        Duration{0});
  }

  CommandDesk& desk;
  std::uint16_t apid;
  std::vector<SettingCommand> commands;
  CommandDone done;
  std::function<void(const SettingCommand&)> refused{};  ///< empty: that ends it
  std::size_t at{0};
};

/// Of the supervisor itself, where it goes on for another one (docs/adr/0205). What is refused is told and holds nothing up: without a
/// supervisor nobody could set it right.
void recall_own(State in, const Means& means, CommandDone done) {
  CommandedMembers& commanded = means.commanded;
  const bool begins = in == State::PreOperational;
  if (begins && means.craft.taking_over && !commanded.owes_own_settings()) commanded.tell_own_lost();
  const auto sending =
      std::make_shared<Sending>(means.desk, supervisor_apid, commanded.own_settings(in),
                                [&commanded, begins, done = std::move(done)](bool success, const std::string& why) {
                                  if (!begins) commanded.own_settings_are_back();
                                  done(success, why);
                                });
  sending->refused = [&commanded](const SettingCommand& command) { commanded.tell_own_not_kept(command); };
  sending->next();
}

}  // namespace

void recall(const ProcedureStep& step, const Means& means, CommandDone done) {
  if (step.subject == supervisor_apid) return recall_own(static_cast<State>(step.values[0]), means, std::move(done));
  const CommandedState* wanted = means.commanded.wanted(step.subject);
  const Member* subject = means.craft.member(step.subject);
  if (wanted == nullptr || subject == nullptr) return done(true, {});
  auto commands = wanted->settings_for(static_cast<State>(step.values[0]), subject->descriptor());
  std::make_shared<Sending>(means.desk, step.subject, std::move(commands), std::move(done))->next();
}

}  // namespace hirosco::supervisor::steps::settings
