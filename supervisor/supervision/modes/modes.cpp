// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/modes.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/supervision/modes/commissioning.hpp"
#include "supervisor/supervision/telecommand/origin.hpp"

namespace hirosco::supervisor {

using descriptor::State;

namespace {

[[nodiscard]] const descriptor::Mode* find_mode(const Craft& craft, std::uint8_t id) {
  const auto& modes = craft.mission.modes;
  const auto found = std::ranges::find(modes, id, &descriptor::Mode::id);
  return found != modes.end() ? &*found : nullptr;
}

/// The words of the failure, which a notice cuts: which mode, because of whom as far as whole words of it fit, and where the rest of it stands.
[[nodiscard]] std::string not_reached(std::string_view mode, std::string_view why) {
  constexpr std::string_view tail = "; hirosco log";
  constexpr std::size_t most = pus::FailureNotice::max_reason_text_octets - tail.size();
  std::string text =
      fmt::format("mode {} not reached", mode.substr(0, most - std::string_view{"mode  not reached"}.size()));
  // Of a plan it is what that answered.
  constexpr std::string_view because = " because of ";
  if (const auto cause = why.find(because); cause != std::string_view::npos) why.remove_prefix(cause + because.size());
  // What it is about; the answer to the step that failed is in the log.
  std::string_view whom = why.substr(0, why.find_first_of(":;"));
  const std::size_t room = most - std::min(most, text.size() + std::string_view{": "}.size());
  if (whom.size() > room) whom = whom.substr(0, std::min(whom.find_last_of(' ', room), whom.size()));
  if (!whom.empty() && whom.size() <= room) text.append(": ").append(whom);
  return text.append(tail);
}

}  // namespace

void Modes::provide() {
  parts_.own.on_function(
      "SET_MODE", [this](double id, Call call) -> Outcome { return set_mode(static_cast<std::uint8_t>(id), call); });
  parts_.own.on_function("ENTER_MODE", [this](double id, Call call) -> Outcome {
    return enter_mode(static_cast<std::uint8_t>(id), call);
  });
}

bool Modes::is_of_subsystem(const Call& call) const noexcept {
  return Origin::of(call.request.source, craft_.mission).is_subsystem();
}

/// A mode is entered while nothing else brings the craft into one.
std::optional<Outcome> Modes::not_now(const Call& call) const {
  if (craft_.shutting_down) return refused(pus::FailureCode::NotPermittedNow, "the craft shuts down");
  if (runner_.running()) return refused(pus::FailureCode::Busy, "another change of mode is under way");
  if (parts_.commissioning.running()) return refused(pus::FailureCode::Busy, "the craft is being commissioned");
  if (is_of_subsystem(call) && craft_.now < subsystems_wait_until_)
    return refused(pus::FailureCode::Busy,
                   "a subsystem was given a mode just now; pause, s:", pause_of_subsystems / std::chrono::seconds{1});
  return std::nullopt;
}

/// What permissions guard, interlocks guard: whoever has moved the craft there by hand is held to them, too.
Outcome Modes::enter_mode(std::uint8_t id, const Call& call) {
  const auto* mode = find_mode(craft_, id);
  if (mode == nullptr) return refused(pus::FailureCode::UnknownIdentifier);
  // The supervisor's own is the last step of commissioning, which was judged with everybody Offline. One that was cancelled has said
  // it, perhaps, and does not mean it any more.
  const bool commissions = call.request.source == supervisor_apid;
  if (commissions && !parts_.commissioning.running())
    return refused(pus::FailureCode::NotPermittedNow, "the commissioning that it ends was stopped");
  if (const auto why = commissions ? std::nullopt : not_now(call)) return *why;
  const Judged judged = commissions ? Judged::WhomItDoesNotCommission : Judged::Everybody;
  const ModePlan plan{.stages = {}, .moved = {}, .against = interlocks_against(craft_, *mode, judged)};
  if (!plan.against.empty()) return impossible(*mode, plan, call);
  enter(*mode);
  begin_pause(call);
  return ok();
}

/// Every reason is told, in the story and to who asked.
Outcome Modes::impossible(const descriptor::Mode& mode, const ModePlan& plan, const Call& call) {
  craft_.tell(fmt::format("mode {} is impossible: {}", mode.name, fmt::join(plan.against, "; ")), supervisor_apid);
  report(call.request.source, mode, plan);
  return refused(pus::FailureCode::WrongStatus,
                 "reasons against it, all of them in TM[129,5]:", static_cast<std::int64_t>(plan.against.size()));
}

Outcome Modes::set_mode(std::uint8_t id, const Call& call) {
  const auto* mode = find_mode(craft_, id);
  if (mode == nullptr) return refused(pus::FailureCode::UnknownIdentifier);
  if (const auto why = not_now(call)) return *why;
  ModePlan plan = plan_mode(craft_, parts_.means.links, parts_.power, *mode);
  object_for_subsystems(plan, call);
  if (!plan.against.empty()) return impossible(*mode, plan, call);
  if (plan.stages.empty()) {
    enter(*mode);
    begin_pause(call);
    return ok();
  }
  change(*mode, std::move(plan), call);
  return hirosco::running;
}

/// Who is stopped, or was never let go, is let go by the ground: a subsystem that asks for a mode would lift a stop by the supervisor's hand.
/// Nor does it take away the ground's own way to the craft.
void Modes::object_for_subsystems(ModePlan& plan, const Call& call) const {
  if (!is_of_subsystem(call)) return;
  for (const std::uint16_t apid : plan.released)
    plan.against.push_back(
        fmt::format("it lets {} move, which the ground may ask for and no subsystem", craft_.name_of(apid)));
  for (const std::uint16_t apid : plan.moved)
    if (craft_.is_ground_link(*craft_.member(apid)))
      plan.against.push_back(fmt::format("it moves {}, the ground link, which the ground may ask for and no subsystem",
                                         craft_.name_of(apid)));
}

void Modes::change(const descriptor::Mode& mode, ModePlan plan, const Call& call) {
  std::vector<std::string> names;
  for (const std::uint16_t apid : plan.moved) names.push_back(craft_.name_of(apid));
  craft_.tell(fmt::format("change from mode {} to {}: {} stages, moves {}", craft_.mode->name, mode.name,
                          plan.stages.size(), fmt::join(names, ", ")),
              supervisor_apid);
  craft_.changing_to = &mode;
  void_permissions();
  call_ = call;
  moved_ = std::move(plan.moved);
  craft_.remember();
  runner_.start({.stages = std::move(plan.stages),
                 .finished = [this, &mode](const ProcedureEnd& end) { ended(mode, end.text()); },
                 .begins =
                     [this, call](std::size_t stage) {
                       stage_ = stage;
                       if (stage > 0) parts_.own.progress(call, static_cast<std::uint16_t>(stage));
                     },
                 .knows_of_no_stop = true});
}

void Modes::ended(const descriptor::Mode& mode, const std::string& failure) {
  // Whoever was taken down, fell, or lost its link after its own step was done.
  const std::string missing = failure.empty() ? missing_from(craft_, parts_.means.links, mode) : failure;
  if (!missing.empty()) return fall_back(missing, StatesFollow::Here);
  craft_.changing_to = nullptr;
  moved_.clear();
  // Here and by no telecommand: one that is under way when the change is cancelled would be carried out after that.
  enter(mode);
  if (const auto call = std::exchange(call_, std::nullopt)) {
    begin_pause(*call);
    parts_.own.finish(*call);
  }
}

Moving Modes::moving(std::uint16_t apid) const {
  if (!running() || std::ranges::find(moved_, apid) == moved_.end()) return Moving::No;
  const bool acts_still = stage_ == 0 && craft_.member(apid)->state() == State::Operational;
  return acts_still ? Moving::ToItsStop : Moving::Beyond;
}

void Modes::stop_now(std::uint16_t apid) {
  if (moving(apid) == Moving::ToItsStop) runner_.knows_of(apid, craft_.guard.fence(apid));
}

Cancelled Modes::cancel(std::string_view why) {
  if (!runner_.running()) return Cancelled::Nothing;
  fall_back(why, StatesFollow::Here);
  return Cancelled::Ended;
}

void Modes::all_stopped(std::string_view why) {
  if (runner_.running()) return fall_back(why, StatesFollow::Elsewhere);
  // What was permitted before the stop and has not been carried out is void, a change of mode above all.
  void_permissions();
}

void Modes::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint8_t>(craft_.changing_to != nullptr ? craft_.changing_to->id : 0));
  writer.put(static_cast<std::uint16_t>(moved_.size()));
  for (const std::uint16_t apid : moved_) writer.put(apid);
}

void Modes::recall(OctetReader& reader) {
  craft_.changing_to = find_mode(craft_, reader.get<std::uint8_t>());
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left)
    if (const auto apid = reader.get<std::uint16_t>(); craft_.member(apid) != nullptr) moved_.push_back(apid);
}

bool Modes::was_moving(std::uint16_t apid) const noexcept {
  return craft_.changing_to != nullptr && std::ranges::find(moved_, apid) != moved_.end();
}

void Modes::end_change(std::string_view why) {
  if (craft_.changing_to != nullptr && !runner_.running()) fall_back(why, StatesFollow::Here);
}

/// Neither the old mode nor the new one holds now: whom the change had in hand is stopped, in the world first, and the mode is
/// the one in which a craft is put right.
void Modes::fall_back(std::string_view why, StatesFollow states) {
  const descriptor::Mode& mode = *std::exchange(craft_.changing_to, nullptr);
  runner_.cancel();
  for (const std::uint16_t apid : moved_) {
    Member& member = *craft_.member(apid);
    if (!member.alive() || craft_.is_ground_link(member)) continue;
    craft_.guard.fence(apid);
    if (states == StatesFollow::Here && member.state() == State::Operational && !member.recovery.running())
      parts_.means.desk.command(apid, "SET_STATE", static_cast<double>(State::SafeOperational), nullptr);
  }
  moved_.clear();
  craft_.tell(fmt::format("the change to mode {} stopped: {}", mode.name, why), supervisor_apid);
  if (const auto* initial = craft_.mission.find_mode(craft_.mission.initial_mode)) enter(*initial);
  if (const auto call = std::exchange(call_, std::nullopt)) {
    begin_pause(*call);
    parts_.own.abort(*call, pus::FailureCode::ExecutionError, not_reached(mode.name, why).c_str());
  }
}

void Modes::enter(const descriptor::Mode& mode) {
  craft_.mode = &mode;
  void_permissions();
  craft_.tell("mode " + mode.name, supervisor_apid);
}

void Modes::begin_pause(const Call& call) {
  if (is_of_subsystem(call)) subsystems_wait_until_ = craft_.now + pause_of_subsystems;
}

void Modes::void_permissions() {
  ++craft_.mode_epoch;
  craft_.remember();
  parts_.own.enter_mode(craft_.mode_epoch);
  for (Member& member : craft_.members) member.enter_mode(craft_.mode_epoch);
}

void Modes::preview(const pus::Request& asked, Octets data) {
  const auto* mode = data.size() == 1 ? find_mode(craft_, std::to_integer<std::uint8_t>(data[0])) : nullptr;
  pus::Verification& verification = parts_.own.verification();
  verification.accepted(asked);
  if (mode == nullptr) return verification.start_failed(asked, pus::FailureNotice{pus::FailureCode::UnknownIdentifier});
  verification.started(asked);
  report(asked.source, *mode, plan_mode(craft_, parts_.means.links, parts_.power, *mode));
  verification.completed(asked);
}

void Modes::report(std::uint16_t destination, const descriptor::Mode& mode, const ModePlan& plan) {
  pus::st129::ModePreview preview{.mode = mode.id, .against = plan.against, .steps = {}};
  for (std::size_t stage = 0; stage < plan.stages.size(); ++stage)
    for (const ProcedureStep& step : plan.stages[stage])
      preview.steps.push_back({static_cast<std::uint8_t>(stage + 1), step.subject, text_of(step, craft_.mission)});
  std::array<std::byte, pus::st129::max_preview_octets> buffer;
  parts_.own.telemetry().report(pus::st129::service_type, pus::st129::mode_preview, destination,
                                pus::st129::write_mode_preview(buffer, preview));
}

}  // namespace hirosco::supervisor
