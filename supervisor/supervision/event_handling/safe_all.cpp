// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/safe_all.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "supervisor/supervision/telecommand/origin.hpp"

namespace hirosco::supervisor {

void SafeAll::provide() {
  own_.on_function("SAFE_ALL", []() -> Outcome { return refused(pus::FailureCode::ExecutionError); });
}

void SafeAll::carry_out(const pus::Request& request) {
  const std::uint64_t stop = craft_.guard.stop_all();
  const bool kept = has_room_for(request);
  if (kept) pending_.push_back({stop, request});
  craft_.remember();
  own_.verification().accepted(request);
  own_.verification().started(request);
  after_stop("SAFE_ALL");
  if (kept) return;
  pus::FailureNotice notice{pus::FailureCode::ExecutionError};
  own_.verification().completion_failed(request,
                                        notice.because({ErrorCode::ResourceExhausted, most_waiting,
                                                        "carried out; the outcome is told for so many at once:"}));
}

bool SafeAll::has_room_for(const pus::Request& request) const {
  if (!Origin::of(request.source, craft_.mission).is_subsystem()) return true;
  const auto is_its = [&](const Pending& each) { return each.request && each.request->source == request.source; };
  return std::ranges::count_if(pending_, is_its) < static_cast<std::ptrdiff_t>(most_waiting);
}

void SafeAll::asked() {
  pending_.push_back({craft_.guard.stop_all(), std::nullopt});
  own_.announce(descriptor::event_of_local_stop);
  after_stop("stop by signal or local socket");
}

void SafeAll::stood_still() {
  // Once more: nothing that was begun in the step in which it stood knows of this one.
  for (const Member& member : craft_.members) craft_.guard.fence(member.apid());
  after_stop("the supervisor itself stood still");
}

void SafeAll::again() {
  if (before_.empty()) before_.emplace_back();
  if (std::ranges::any_of(before_, [](const auto& asked) { return !asked; }))
    own_.announce(descriptor::event_of_local_stop);
  for (const auto& request : std::exchange(before_, {})) pending_.push_back({craft_.guard.stop_all(), request});
  after_stop("a stop that the supervisor before had not ended");
}

void SafeAll::asked_meanwhile() {
  if (std::ranges::all_of(before_, [](const auto& asked) { return asked.has_value(); })) before_.emplace_back();
}

void SafeAll::tell_again() {
  if (ground_hears_) tell_before();
}

/// It stays as it was: whoever has been let go since is not stopped again for a report.
void SafeAll::tell_before() {
  for (const End& end : std::exchange(told_before_, {})) {
    // Ahead of the report, which may be the second one: whoever hears it twice can tell.
    own_.announce("END_TOLD_AGAIN", {static_cast<double>(end.request.id), static_cast<double>(end.request.source)});
    craft_.tell("the end of a SAFE_ALL is told once more: ground may have heard it", supervisor_apid);
    told_.push_back(end);
    tell(end);
  }
  keep_bounded();
}

void SafeAll::keep_bounded() {
  if (told_.size() > most_told) told_.erase(told_.begin(), told_.end() - most_told);
}

void SafeAll::ground_hears(bool now) {
  if (std::exchange(ground_hears_, now) == now) return;
  // What waited in the route is dropped with the link.
  for (End& end : told_) end.heard = false;
  if (!now) return;
  told_before_.insert(told_before_.end(), told_.begin(), told_.end());
  told_.clear();
  tell_before();
}

void SafeAll::hear(std::uint16_t from, const pus::TelemetryView& report) {
  if (!ground_hears_ || told_.empty() || from != supervisor_apid || report.service() != 1 || report.subtype() < 7)
    return;
  const auto id = OctetReader{report.source_data()}.get<std::uint32_t>();
  for (End& end : told_)
    if (end.request.id == id && end.request.source == report.destination()) end.heard = true;
}

void SafeAll::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint16_t>(pending_.size() + before_.size()));
  const auto put = [&](const std::optional<pus::Request>& asked) {
    const pus::Request request = asked.value_or(pus::Request{});
    writer.put(static_cast<std::uint8_t>(asked ? 1 : 0)).put(request.id).put(request.source).put(request.ack);
  };
  for (const Pending& pending : pending_) put(pending.request);
  for (const auto& asked : before_) put(asked);
  writer.put(static_cast<std::uint16_t>(told_.size() + told_before_.size()));
  for (const auto* ends : {&told_, &told_before_})
    for (const End& end : *ends) {
      put(end.request);
      writer.put(static_cast<std::uint16_t>(end.moving.size()));
      for (const std::uint16_t apid : end.moving) writer.put(apid);
    }
}

void SafeAll::recall(OctetReader& reader) {
  const auto get = [&]() -> std::optional<pus::Request> {
    const bool asked = reader.get<std::uint8_t>() != 0;
    const auto id = reader.get<std::uint32_t>();
    const auto source = reader.get<std::uint16_t>();
    const pus::Request request{id, source, reader.get<std::uint8_t>()};
    return asked ? std::optional{request} : std::nullopt;
  };
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) before_.push_back(get());
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    End& end = told_before_.emplace_back(End{get().value_or(pus::Request{}), {}});
    for (auto moving = reader.get<std::uint16_t>(); moving > 0 && reader.good(); --moving)
      end.moving.push_back(reader.get<std::uint16_t>());
  }
  // One generation after another that cannot tell would fill what is noted.
  if (told_before_.size() > most_told) told_before_.erase(told_before_.begin(), told_before_.end() - most_told);
}

void SafeAll::after_stop(std::string_view why) {
  craft_.tell(std::string{why} + ": every actuator inhibited", supervisor_apid);
  // Commissioning, or a change of mode, would lift the fences again with its next step.
  for (Undertaking* each : under_way_) each->all_stopped(why);
  follow_.clear();
  for (const Member& member : craft_.members)
    // The ground link has no actuators and is needed now more than ever.
    if (!craft_.is_ground_link(member)) follow_.push_back(member.apid());
  states_follow();
}

void SafeAll::states_follow() {
  if (craft_.shutting_down) return;  // which leads everybody farther down, in its order
  std::erase_if(follow_, [this](std::uint16_t apid) {
    const Member& subject = *craft_.member(apid);
    if (!subject.alive()) return false;
    if (!craft_.guard.fenced(apid)) return true;  // it was let go
    if (subject.state() != State::Operational) return false;
    desk_.command(apid, "SET_STATE", static_cast<double>(State::SafeOperational), nullptr);
    return true;
  });
}

void SafeAll::follow() {
  states_follow();
  std::vector<End> ended;
  while (!pending_.empty()) {
    const auto answers = craft_.guard.stop_outcome(pending_.front().stop);
    if (!answers) break;
    const auto moving = tell_outcome(*answers);
    const auto& request = pending_.front().request;
    if (request && (!moving.empty() || (request->ack & pus::ack_completion) != 0)) ended.push_back({*request, moving});
    pending_.erase(pending_.begin());
  }
  if (ended.empty()) return;
  told_.insert(told_.end(), ended.begin(), ended.end());
  keep_bounded();
  // Before the first of them can leave: whoever goes on does not carry out again what has ended, and knows what it may be telling twice.
  craft_.remember();
  for (const End& end : ended) tell(end);
}

std::vector<std::uint16_t> SafeAll::tell_outcome(const std::vector<StopAnswer>& answers) {
  std::vector<std::uint16_t> moving;
  for (const StopAnswer& answer : answers) {
    const std::string who = craft_.name_of(answer.apid);
    if (answer.killed) craft_.tell(who + " was ended: " + answer.name + " had not stopped in time", answer.apid);
    if (!answer.otherwise.empty())
      craft_.tell(fmt::format("{} of {} has stopped, but {}", answer.name, who, answer.otherwise), answer.apid);
    if (answer.stopped) continue;
    craft_.tell(answer.name + " of " + who + " did not confirm that it stopped", answer.apid);
    if (std::ranges::find(moving, answer.apid) == moving.end() && moving.size() < most_named)
      moving.push_back(answer.apid);
  }
  if (moving.empty()) craft_.tell("everything has stopped", supervisor_apid);
  return moving;
}

void SafeAll::tell(const End& end) {
  if (end.moving.empty()) return own_.verification().completed(end.request);
  pus::FailureNotice notice{pus::FailureCode::DeviceError};
  for (const std::uint16_t apid : end.moving) notice.with(apid);
  own_.verification().completion_failed(end.request, notice);
}

}  // namespace hirosco::supervisor
