// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/replacement.hpp"

#include <fmt/format.h>

#include <utility>

#include "hirosco/descriptor/read/read.hpp"
#include "supervisor/supervision/event_handling/reactions.hpp"
#include "supervisor/supervision/modes/under_way.hpp"
#include "supervisor/supervision/subsystem_handling/processes.hpp"
#include "supervisor/supervision/subsystem_handling/version_texts.hpp"

namespace hirosco::supervisor {

using descriptor::Severity;
using pus::FailureCode;

namespace {

[[nodiscard]] std::string words_of(const std::string& version) {
  return version.empty() ? std::string{"the mission's own version"} : "version " + version;
}

/// Nothing: it may be exchanged now.
[[nodiscard]] std::optional<Outcome> against(const Craft& craft, const UnderWay& under_way, const Member* subject) {
  if (subject == nullptr) return refused(FailureCode::UnknownIdentifier);
  if (craft.is_ground_link(*subject))
    return refused(FailureCode::NotPermittedNow, "it carries the ground link: nobody could confirm it");
  if (craft.shutting_down) return refused(FailureCode::NotPermittedNow, "the craft shuts down");
  if (under_way.running()) return refused(FailureCode::Busy, "the craft is commissioned or changes its mode");
  if (subject->descriptor_changes) return refused(FailureCode::Busy, "its descriptor is being read again");
  if (subject->alive() && (subject->state() != State::Offline || subject->recovery.running()))
    return refused(FailureCode::WrongStatus, "it is not Offline");
  return std::nullopt;
}

/// By the thread that reads programs: who goes on for another supervisor has not read all of them at once.
[[nodiscard]] bool is_being_read(ProcessLauncher& launcher, const Member& subject, const std::string& version) {
  const auto ready = launcher.prepare(subject.described(), version);
  return ready && !*ready;
}

}  // namespace

void Replacement::provide() {
  parts_.own.on_function(
      "REPLACE", [this](std::uint16_t apid, std::string_view version, std::uint16_t within_s, Call call) -> Outcome {
        return replace(apid, version, std::chrono::seconds{within_s}, call);
      });
  parts_.own.on_function("CONFIRM",
                         [this](double apid) -> Outcome { return confirm(static_cast<std::uint16_t>(apid)); });
  parts_.own.on_function("TAKE_BACK", [this](double apid, Call call) -> Outcome {
    return take_back(static_cast<std::uint16_t>(apid), call);
  });
}

Outcome Replacement::replace(std::uint16_t apid, std::string_view version, Duration within, const Call& call) {
  const Member* subject = craft_.member(apid);
  if (const auto why_not = against(craft_, parts_.under_way, subject)) return *why_not;
  if (!descriptor::is_version(version)) return refused(FailureCode::ValueNotAcceptable, "that is no name of a version");
  if (changes_.contains(apid)) return refused(FailureCode::WrongStatus, "a version of it is on its way or on trial");
  Change change;
  change.wanted = version;
  change.before = in_force_[apid];
  if (change.wanted == change.before) return refused(FailureCode::WrongStatus, "that is what it is already");
  change.within = within;
  change.deadline = craft_.now + longest_reading;
  change.call = call;
  changes_.emplace(apid, std::move(change));
  return running;
}

Outcome Replacement::confirm(std::uint16_t apid) {
  const auto found = changes_.find(apid);
  if (found == changes_.end() || found->second.phase != Phase::OnTrial)
    return refused(FailureCode::WrongStatus, "no version of it is on trial");
  Member& subject = *craft_.member(apid);
  const std::string dropped = std::exchange(earlier_[apid], found->second.before);
  in_force_[apid] = found->second.wanted;
  changes_.erase(found);
  settle(subject, dropped);
  craft_.tell(subject.descriptor().name + " stays " + words_of(in_force_[apid]) + ": confirmed", apid);
  return ok();
}

Outcome Replacement::take_back(std::uint16_t apid, const Call& call) {
  Member* subject = craft_.member(apid);
  if (const auto why_not = against(craft_, parts_.under_way, subject)) return *why_not;
  auto found = changes_.find(apid);
  if (found != changes_.end() && found->second.phase != Phase::OnTrial)
    return refused(FailureCode::Busy, "a version of it is on its way");
  if (found == changes_.end()) {
    if (!earlier_.contains(apid))
      return refused(FailureCode::WrongStatus, "it has had no other version in this flight");
    found = changes_.emplace(apid, Change{}).first;
    found->second.wanted = in_force_[apid];
    found->second.before = std::exchange(earlier_[apid], in_force_[apid]);
  }
  found->second.go_back();
  subject->brings_text = parts_.texts.has(apid, found->second.wanted);
  found->second.call = call;
  end_process(*subject, found->second);
  return running;
}

void Replacement::died(std::uint16_t apid) {
  const auto found = changes_.find(apid);
  if (found == changes_.end() || (found->second.phase != Phase::OnTrial && found->second.phase != Phase::GoingDown))
    return;
  Member& subject = *craft_.member(apid);
  craft_.tell(fmt::format("{} died as {}, which was not confirmed: {} is next", subject.descriptor().name,
                          words_of(found->second.wanted), words_of(found->second.before)),
              apid);
  found->second.go_back();
  end_process(subject, found->second);
  craft_.launcher.use(subject.described(), found->second.wanted);
}

void Replacement::note(OctetWriter& writer) const {
  VersionNotes notes{.in_force = in_force_, .earlier = earlier_, .on_trial = {}};
  for (const auto& [apid, change] : changes_) {
    if (change.phase == Phase::Reading || (change.phase == Phase::Ending && change.trial)) continue;
    // Who is on the way back goes it from its begin again.
    notes.on_trial.push_back(
        {apid, change.trial ? change.wanted : change.before, change.trial ? change.before : change.wanted});
  }
  write(writer, notes);
}

void Replacement::recall(OctetReader& reader) {
  VersionNotes notes = read_version_notes(reader);
  in_force_ = std::move(notes.in_force);
  earlier_ = std::move(notes.earlier);
  for (const auto& [apid, version] : earlier_)
    if (const Member* member = craft_.member(apid)) static_cast<void>(parts_.texts.recall(*member, version));
  for (const auto& [apid, wanted, before] : notes.on_trial) {
    Member* member = craft_.member(apid);
    if (member == nullptr) continue;
    member->brings_text = parts_.texts.recall(*member, before);
    changes_[apid] = {.phase = Phase::OnTrial, .wanted = wanted, .before = before, .deadline = craft_.now};
  }
  for (const Member& member : craft_.members) {
    const auto change = changes_.find(member.apid());
    const auto found = in_force_.find(member.apid());
    if (change != changes_.end()) craft_.launcher.use(member.described(), change->second.wanted);
    else if (found != in_force_.end()) craft_.launcher.use(member.described(), found->second);
  }
}

void Replacement::watch(TimePoint now) {
  parts_.texts.watch();
  for (auto entry = changes_.begin(); entry != changes_.end();) {
    const bool over = step(*craft_.member(entry->first), entry->second, now);
    entry = over ? changes_.erase(entry) : std::next(entry);
  }
}

bool Replacement::step(Member& subject, Change& change, TimePoint now) {
  if (craft_.shutting_down) {
    give_up(change, FailureCode::Aborted, "the craft shuts down");
    return true;
  }
  switch (change.phase) {
    case Phase::Reading: return read(subject, change, now);
    case Phase::Ending:
      if (change.process != 0 && !craft_.launcher.ended(change.process)) {
        if (now > change.deadline) craft_.launcher.kill(change.process);
        return false;
      }
      change.process = 0;
      change.deadline = now + longest_reading;
      return exchange(subject, change, now);
    case Phase::Starting: return start(subject, change, now);
    case Phase::OnTrial:
      if (now < change.deadline) return false;
      craft_.tell(
          fmt::format("{} was not confirmed as {} in its time", subject.descriptor().name, words_of(change.wanted)),
          subject.apid());
      change.phase = Phase::GoingDown;
      change.deadline = now + longest_way_down;
      if (subject.alive() && subject.state() != State::Offline)
        parts_.reactions.react(subject, "VERSION_NOT_CONFIRMED", Severity::High);
      return false;
    case Phase::GoingDown: return bring_down(subject, change, now);
  }
  return true;
}

bool Replacement::read(Member& subject, Change& change, TimePoint now) {
  const auto ready = craft_.launcher.prepare(subject.described(), change.wanted);
  if (!ready) {
    craft_.tell(fmt::format("{} stays {}: {}", subject.descriptor().name, words_of(change.before), ready.error().words),
                subject.apid());
    parts_.texts.let_go(subject);
    give_up(change, FailureCode::ExecutionError, ready.error().why.text);
    return true;
  }
  using enum VersionTexts::Found;
  const std::uint16_t asked_by = change.call ? change.call->request.source : std::uint16_t{0};
  const auto found = *ready ? parts_.texts.look(subject, asked_by) : NotYet;
  if (found == NotYet && now < change.deadline) return false;
  if (found == NotYet) {
    parts_.texts.let_go(subject);
    give_up(change, FailureCode::Timeout, "its file is not read in time");
    return true;
  }
  if (found == Refused) {
    give_up(change, FailureCode::ValueNotAcceptable,
            "problems, each in a TM[129,10]:", static_cast<std::int64_t>(parts_.texts.problems()));
    return true;
  }
  if (against(craft_, parts_.under_way, &subject)) {
    parts_.texts.let_go(subject);
    give_up(change, FailureCode::Aborted, "it is not Offline any more");
    return true;
  }
  end_process(subject, change);
  return false;
}

/// It holds nothing in Offline: its channel is closed, and it ends. Nobody else starts it meanwhile.
void Replacement::end_process(Member& subject, Change& change) {
  change.phase = Phase::Ending;
  change.deadline = craft_.now + longest_end;
  change.process = 0;
  subject.exchanged = true;
  if (!subject.alive()) return;
  change.process = subject.process();
  parts_.processes.let_go(subject);
}

/// Nobody runs: a text that comes with the version, or goes with it, changes now. What is in force is noted at the end of this step.
bool Replacement::exchange(Member& subject, Change& change, TimePoint now) {
  const bool back = !change.trial && parts_.texts.has(subject.apid(), change.wanted);
  if (change.trial ? !subject.brings_text : !back) return start(subject, change, now);
  if (back) parts_.texts.go_back(subject, change.before, change.wanted);
  else parts_.texts.take(subject, change.before);
  change.phase = Phase::Starting;
  return false;
}

bool Replacement::start(Member& subject, Change& change, TimePoint now) {
  const std::uint16_t apid = subject.apid();
  const std::string& name = subject.descriptor().name;
  if (!change.trial && now < change.deadline && is_being_read(craft_.launcher, subject, change.wanted)) {
    change.phase = Phase::Starting;
    return false;
  }
  subject.exchanged = false;
  craft_.launcher.use(subject.described(), change.wanted);
  const bool started = parts_.processes.start(apid).has_value();
  if (!change.trial) {
    in_force_[apid] = change.wanted;
    if (started) craft_.tell(name + " runs " + words_of(change.wanted) + " again", apid);
    parts_.own.announce("VERSION_BACK", {static_cast<double>(apid)});
    settle(subject, change.before);
    if (started) finish(change);
    else give_up(change, FailureCode::ExecutionError, "its process could not be started");
    return true;
  }
  if (!started) {
    give_up(change, FailureCode::ExecutionError, "its process could not be started");
    change.go_back();
    change.phase = Phase::Ending;
    subject.exchanged = true;
    return false;
  }
  craft_.tell(
      fmt::format("{} runs {}: CONFIRM within {} s keeps it", name, words_of(change.wanted), change.within / 1s), apid);
  parts_.own.announce("VERSION_STARTED", {static_cast<double>(apid)});
  change.phase = Phase::OnTrial;
  change.deadline = now + change.within;
  finish(change);
  return false;
}

bool Replacement::bring_down(Member& subject, Change& change, TimePoint now) {
  if (!subject.alive() || subject.state() == State::Offline) {
    change.go_back();
    end_process(subject, change);
  } else if (now > change.deadline) {
    craft_.launcher.kill(subject.process());  // died() goes on
  }
  return false;
}

void Replacement::finish(Change& change) {
  if (const auto call = std::exchange(change.call, std::nullopt)) parts_.own.finish(*call);
}

void Replacement::give_up(Change& change, FailureCode code, const char* words, std::int64_t number) {
  if (const auto call = std::exchange(change.call, std::nullopt)) parts_.own.abort(*call, code, words, number);
}

void Replacement::settle(Member& subject, const std::string& left) {
  const auto earlier = earlier_.find(subject.apid());
  const std::string* const kept = earlier != earlier_.end() ? &earlier->second : nullptr;
  const bool needed = left.empty() || left == in_force_[subject.apid()] || (kept != nullptr && left == *kept);
  if (!needed) craft_.launcher.drop(subject.described(), left);
  parts_.texts.keep_only(subject, kept);
  subject.brings_text = false;
}

}  // namespace hirosco::supervisor
