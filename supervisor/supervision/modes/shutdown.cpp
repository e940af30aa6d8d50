// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/shutdown.hpp"

namespace hirosco::supervisor {

using descriptor::State;

namespace {
constexpr Duration limit = 5s;
}

void Shutdown::provide(Telecommands& telecommands) {
  own_.on_function("SHUTDOWN", []() -> Outcome { return refused(pus::FailureCode::ExecutionError); });
  telecommands.at_once("SHUTDOWN", [this](const pus::Request& asked) {
    own_.verification().accepted(asked);
    own_.verification().started(asked);
    request();
    own_.verification().completed(asked);
  });
}

void Shutdown::request() {
  if (craft_.shutting_down) return;
  craft_.shutting_down = true;
  deadline_ = craft_.now + limit;
  craft_.tell("shutdown");
  commissioning_.drop();
  Sequence::Stage safe, offline, ground;
  for (const Member& member : craft_.members) {
    const auto add = [&](Sequence::Stage& stage, State target) {
      stage.push_back({member.apid(), member.descriptor().name, "SET_STATE", static_cast<double>(target),
                       std::string{to_text(target)}});
    };
    if (!member.alive()) continue;
    const bool moves = member.state() == State::Operational;
    const bool away = member.state() && member.state() != State::Offline;
    if (moves) add(safe, State::SafeOperational);
    // The ground link goes last, so that the ground sees the others go.
    if (craft_.is_ground_link(member)) add(ground, State::Offline);
    else if (away) add(offline, State::Offline);
  }
  sequence_.start({safe, offline, ground}, Sequence::OnFailure::GoOn, [this](bool success, const std::string& why) {
    if (!success) craft_.tell("shutdown: " + why);
    for (Member& member : craft_.members) member.died();  // closing the channel ends the process
    finished_ = true;
  });
}

void Shutdown::enforce(TimePoint now) {
  if (!craft_.shutting_down || finished_ || now <= deadline_) return;
  craft_.tell("shutdown: time limit, ending what is left");
  for (Member& member : craft_.members)
    if (member.alive()) craft_.launcher.kill(member.process());
  for (Member& member : craft_.members) member.died();
  sequence_.cancel();
  craft_.failed = true;
  finished_ = true;
}

}  // namespace hirosco::supervisor
