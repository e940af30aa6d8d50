// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/shutdown.hpp"

#include <string>
#include <utility>

#include "supervisor/supervision/data_handling/reception.hpp"
#include "supervisor/supervision/procedures/steps/step_kinds.hpp"

namespace hirosco::supervisor {

using descriptor::State;

namespace {
constexpr Duration limit = 5s;
}

void Shutdown::provide() {
  parts_.own.on_function("SHUTDOWN", []() -> Outcome { return refused(pus::FailureCode::ExecutionError); });
}

void Shutdown::command(const pus::Request& asked) {
  parts_.own.verification().accepted(asked);
  parts_.own.verification().started(asked);
  const bool of_a_member = craft_.member(asked.source) != nullptr;
  request(of_a_member ? "telecommand of " + craft_.name_of(asked.source)
                      : "telecommand from ground, source id " + std::to_string(asked.source));
  parts_.own.verification().completed(asked);
}

void Shutdown::request(std::string_view by) {
  if (craft_.shutting_down) return;
  craft_.shutting_down = true;
  craft_.remember();
  deadline_ = craft_.now + limit;
  craft_.tell(by.empty() ? "shutdown" : "shutdown, asked for by " + std::string{by});
  parts_.under_way.drop();
  // Nobody moves on until its service loop has obeyed, and nothing that waited for the disk begins to.
  for (const Member& member : craft_.members)
    if (!craft_.is_ground_link(member)) craft_.guard.fence(member.apid());
  parts_.accounts.refuse_waiting();
  Stage safe, offline;
  for (const Member& member : craft_.members) {
    if (!member.alive() || !member.state() || member.state() == State::Offline) continue;
    if (member.state() == State::Operational) safe.push_back(to_state(member.apid(), State::SafeOperational));
    if (!craft_.is_ground_link(member)) offline.push_back(to_state(member.apid(), State::Offline));
  }
  runner_.start({.stages = {safe, offline},
                 .on_failure = Procedure::OnFailure::GoOn,
                 .finished = [this](const ProcedureEnd& done) {
                   if (!done.success) craft_.tell("shutdown: " + done.text());
                   others_down_ = true;
                 }});
}

/// Not while somebody's channel is read. Of whom it is said that its outcome is unknown nothing is heard any more: each
/// telecommand has one end.
void Shutdown::end_others() {
  for (Member& member : craft_.members) {
    if (craft_.is_ground_link(member)) continue;
    parts_.reception.read(member);  // its last words
    member.died();  // closing the channel ends the process
    parts_.accounts.outcome_unknown(member.apid());
  }
}

/// Last, so that the ground sees the others go, and hears what became of what it had asked them.
void Shutdown::bring_down_ground_link() {
  parts_.accounts.refuse_waiting();
  Stage ground;
  if (const Member* link = craft_.ground_link(); link != nullptr && link->alive())
    ground.push_back(to_state(link->apid(), State::Offline));
  runner_.start(
      {.stages = {ground}, .on_failure = Procedure::OnFailure::GoOn, .finished = [this](const ProcedureEnd& done) {
         if (!done.success) craft_.tell("shutdown: " + done.text());
         end();
       }});
}

void Shutdown::end() {
  parts_.accounts.refuse_waiting();
  for (Member& member : craft_.members) {
    parts_.accounts.outcome_unknown(member.apid());
    member.died();
  }
  ended_ = true;
}

void Shutdown::enforce(TimePoint now) {
  if (!craft_.shutting_down || finished_) return;
  if (ended_) {
    finished_ = true;
  } else if (std::exchange(others_down_, false)) {
    end_others();
    bring_down_ground_link();
  } else if (now > deadline_) {
    craft_.tell("shutdown: time limit, ending what is left");
    for (Member& member : craft_.members)
      if (member.alive()) craft_.launcher.kill(member.process());
    runner_.cancel();
    craft_.fail();
    end();
  }
}

}  // namespace hirosco::supervisor
