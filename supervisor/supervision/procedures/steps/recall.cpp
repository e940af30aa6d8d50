// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/steps/recall.hpp"

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
        [self = shared_from_this()](bool success, const std::string& why) {
          if (success) self->next();
          else self->done(false, why);
        },
        Duration{0});
  }

  CommandDesk& desk;
  std::uint16_t apid;
  std::vector<SettingCommand> commands;
  CommandDone done;
  std::size_t at{0};
};

}  // namespace

void recall(const ProcedureStep& step, const Means& means, CommandDone done) {
  const CommandedState* wanted = means.commanded.wanted(step.subject);
  const Member* subject = means.craft.member(step.subject);
  if (wanted == nullptr || subject == nullptr) return done(true, {});
  auto commands = wanted->settings_for(static_cast<State>(step.values[0]), subject->descriptor());
  std::make_shared<Sending>(means.desk, step.subject, std::move(commands), std::move(done))->next();
}

}  // namespace hirosco::supervisor::steps::settings
