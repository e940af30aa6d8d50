// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/replacement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "hirosco/descriptor/read/read.hpp"
#include "supervisor/supervision/event_handling/reactions.hpp"
#include "supervisor/supervision/modes/under_way.hpp"
#include "supervisor/supervision/subsystem_handling/processes.hpp"

namespace hirosco::supervisor {

using descriptor::Severity;
using pus::FailureCode;

namespace {

[[nodiscard]] std::string words_of(const std::string& version) {
  return version.empty() ? std::string{"the mission's own version"} : "version " + version;
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

std::optional<Outcome> Replacement::against(const Member* subject) const {
  if (subject == nullptr) return refused(FailureCode::UnknownIdentifier);
  if (craft_.is_ground_link(*subject))
    return refused(FailureCode::NotPermittedNow, "it carries the ground link: nobody could confirm it");
  if (craft_.shutting_down) return refused(FailureCode::NotPermittedNow, "the craft shuts down");
  if (parts_.under_way.running()) return refused(FailureCode::Busy, "the craft is commissioned or changes its mode");
  if (subject->alive() && (subject->state() != State::Offline || subject->recovery.running()))
    return refused(FailureCode::WrongStatus, "it is not Offline");
  return std::nullopt;
}

Outcome Replacement::replace(std::uint16_t apid, std::string_view version, Duration within, const Call& call) {
  const Member* subject = craft_.member(apid);
  if (const auto why_not = against(subject)) return *why_not;
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
  const Member& subject = *craft_.member(apid);
  const std::string dropped = std::exchange(earlier_[apid], found->second.before);
  in_force_[apid] = found->second.wanted;
  changes_.erase(found);
  drop_unless_needed(subject, dropped);
  craft_.tell(subject.descriptor().name + " stays " + words_of(in_force_[apid]) + ": confirmed", apid);
  return ok();
}

Outcome Replacement::take_back(std::uint16_t apid, const Call& call) {
  Member* subject = craft_.member(apid);
  if (const auto why_not = against(subject)) return *why_not;
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
  go_back(found->second);
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
  go_back(found->second);
  end_process(subject, found->second);
  craft_.launcher.use(subject.described(), found->second.wanted);
}

void Replacement::note(OctetWriter& writer) const {
  const auto put = [&](const std::string& text) {
    writer.put(static_cast<std::uint8_t>(text.size())).put(std::as_bytes(std::span{text}));
  };
  for (const auto* versions : {&in_force_, &earlier_}) {
    writer.put(static_cast<std::uint16_t>(versions->size()));
    for (const auto& [apid, version] : *versions) {
      writer.put(apid);
      put(version);
    }
  }
  const auto is_new = [](const auto& entry) {
    return entry.second.phase == Phase::OnTrial || entry.second.phase == Phase::GoingDown;
  };
  writer.put(static_cast<std::uint16_t>(std::ranges::count_if(changes_, is_new)));
  for (const auto& entry : changes_) {
    if (!is_new(entry)) continue;
    writer.put(entry.first);
    put(entry.second.wanted);
    put(entry.second.before);
  }
}

void Replacement::recall(OctetReader& reader) {
  const auto get = [&] {
    const Octets text = reader.get(reader.get<std::uint8_t>());
    return std::string{reinterpret_cast<const char*>(text.data()), text.size()};
  };
  for (auto* versions : {&in_force_, &earlier_})
    for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
      const auto apid = reader.get<std::uint16_t>();
      (*versions)[apid] = get();
    }
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    const auto apid = reader.get<std::uint16_t>();
    Change change;
    change.phase = Phase::OnTrial;
    change.wanted = get();
    change.before = get();
    change.deadline = craft_.now;
    if (craft_.member(apid) != nullptr) changes_.emplace(apid, std::move(change));
  }
  for (const Member& member : craft_.members) {
    const auto change = changes_.find(member.apid());
    const auto found = in_force_.find(member.apid());
    if (change != changes_.end()) craft_.launcher.use(member.described(), change->second.wanted);
    else if (found != in_force_.end()) craft_.launcher.use(member.described(), found->second);
  }
}

void Replacement::watch(TimePoint now) {
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
      return start(subject, change, now);
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
    give_up(change, FailureCode::ExecutionError, ready.error().why.text);
    return true;
  }
  if (!*ready && now < change.deadline) return false;
  if (!*ready) {
    give_up(change, FailureCode::Timeout, "its file is not read in time");
    return true;
  }
  if (against(&subject)) {
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

bool Replacement::start(Member& subject, Change& change, TimePoint now) {
  const std::uint16_t apid = subject.apid();
  const std::string& name = subject.descriptor().name;
  subject.exchanged = false;
  craft_.launcher.use(subject.described(), change.wanted);
  const bool started = parts_.processes.start(apid).has_value();
  if (!change.trial) {
    in_force_[apid] = change.wanted;
    if (started) craft_.tell(name + " runs " + words_of(change.wanted) + " again", apid);
    parts_.own.announce("VERSION_BACK", {static_cast<double>(apid)});
    drop_unless_needed(subject, change.before);
    if (started) finish(change);
    else give_up(change, FailureCode::ExecutionError, "its process could not be started");
    return true;
  }
  if (!started) {
    give_up(change, FailureCode::ExecutionError, "its process could not be started");
    go_back(change);
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
    go_back(change);
    end_process(subject, change);
  } else if (now > change.deadline) {
    craft_.launcher.kill(subject.process());  // died() goes on
  }
  return false;
}

void Replacement::go_back(Change& change) {
  std::swap(change.wanted, change.before);
  change.trial = false;
}

void Replacement::finish(Change& change) {
  if (change.call) parts_.own.finish(*change.call);
  change.call.reset();
}

void Replacement::give_up(Change& change, FailureCode code, const char* words) {
  if (change.call) parts_.own.abort(*change.call, code, words);
  change.call.reset();
}

void Replacement::drop_unless_needed(const Member& subject, const std::string& version) {
  const std::uint16_t apid = subject.apid();
  const auto earlier = earlier_.find(apid);
  if (version.empty() || version == in_force_[apid] || (earlier != earlier_.end() && version == earlier->second))
    return;
  craft_.launcher.drop(subject.described(), version);
}

}  // namespace hirosco::supervisor
