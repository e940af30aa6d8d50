// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/descriptors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "hirosco/pus/st130_descriptor/descriptor_service.hpp"
#include "supervisor/supervision/data_handling/persistent_values/stored_values.hpp"
#include "supervisor/supervision/modes/under_way.hpp"
#include "supervisor/supervision/subsystem_handling/fresh_descriptor.hpp"

namespace hirosco::supervisor {

using descriptor::not_in_flight;
using descriptor::State;
using pus::DescriptorService;
using pus::FailureCode;

namespace {

/// Sealed memory that holds the text.
[[nodiscard]] Result<MemoryHandle> sealed(MemoryProvider& memory, const std::string& text) {
  HIROSCO_TRY_LET(MemoryHandle handle, memory.create("hirosco-descriptor", text.size()));
  HIROSCO_TRY_LET(const Mapping mapped, memory.map(handle, Access::ReadWrite));
  std::memcpy(mapped.octets.data(), text.data(), text.size());
  HIROSCO_TRY(memory.seal_writers(handle));
  return handle;
}

}  // namespace

void Descriptors::provide() {
  parts_.own.on_function("REREAD", [this](std::uint16_t apid, Call call) -> Outcome { return reread(apid, call); });
}

std::optional<Outcome> Descriptors::against(const Member* subject) const {
  if (subject == nullptr) return refused(FailureCode::UnknownIdentifier);
  if (parts_.readings == nullptr) return refused(FailureCode::NotPermittedNow, "this flight reads no file again");
  if (craft_.shutting_down) return refused(FailureCode::NotPermittedNow, "the craft shuts down");
  if (parts_.under_way.running()) return refused(FailureCode::Busy, "the craft is commissioned or changes its mode");
  for (const Member& member : craft_.members) {
    // The whole mission is judged, and that text of it changes in this moment.
    if (member.exchanged && member.brings_text)
      return refused(FailureCode::Busy, "a version that brings its text is about to be started", member.apid());
    if (member.descriptor().file != subject->descriptor().file) continue;
    if (member.exchanged) return refused(FailureCode::Busy, "another version of it is about to be started");
    if (member.brings_text)
      return refused(FailureCode::Busy, "a version that brought its text is on trial: CONFIRM or TAKE_BACK");
    if (!member.alive()) continue;
    if (member.recovery.running()) return refused(FailureCode::Busy, "a plan has it in hand");
    const auto state = member.state();
    if (state != State::Offline && state != State::PreOperational)
      return refused(FailureCode::WrongStatus,
                     "everybody who flies it has to be Offline or in Pre-Operational; not so is", member.apid());
  }
  return std::nullopt;
}

std::vector<descriptor::MissionSubsystem*> Descriptors::flying(const std::filesystem::path& file) {
  std::vector<descriptor::MissionSubsystem*> found;
  for (auto& member : craft_.mission.subsystems)
    if (member.subsystem.file == file) found.push_back(&member);
  return found;
}

Outcome Descriptors::reread(std::uint16_t apid, const Call& call) {
  const Member* subject = std::as_const(craft_).member(apid);
  if (auto why_not = against(subject)) return *why_not;
  if (phase_ != Phase::Idle) return refused(FailureCode::Busy, "another descriptor is being read again");
  if (const auto begun = parts_.readings->begin(craft_.mission, subject->descriptor().file); !begun)
    return refused(FailureCode::Busy, begun.error().text);
  phase_ = Phase::Reading;
  apid_ = apid;
  file_ = subject->descriptor().file;
  call_ = call;
  deadline_ = craft_.now + longest_reading;
  return running;
}

void Descriptors::watch(TimePoint now) {
  // What a disk gives that late is of no use to anybody, but keeps no later one from being read.
  if (late_ && parts_.readings->outcome()) late_ = false;
  const bool open = std::ranges::any_of(asked_, [](const auto& each) { return each.second.answer == Answer::Open; });
  switch (phase_) {
    case Phase::Idle: return;
    case Phase::Reading:
      if (auto reading = parts_.readings->outcome()) return judge(std::move(*reading));
      if (now <= deadline_) return;
      late_ = true;
      give_up(FailureCode::Timeout, "its file is not read in time");
      return;
    case Phase::Judging:
      if (!open) judged();
      return;
    case Phase::Taking:
      if (!open) taken();
      return;
  }
}

void Descriptors::judge(DescriptorReading reading) {
  if (!reading.mission.value) return refuse(reading.mission.problems);
  if (auto why_not = against(std::as_const(craft_).member(apid_)))
    return give_up(FailureCode::WrongStatus, "it has left Offline and Pre-Operational, or a change has begun");
  text_ = std::move(reading.text);
  const auto flown = flying(file_);
  texts_ = std::move(reading.mission.value->texts);
  if (flown.front()->subsystem.text && *flown.front()->subsystem.text == *text_) {
    // What its files bring along may be another all the same.
    for (descriptor::MissionSubsystem* member : flown)
      if (auto* fresh = reading.mission.value->find_subsystem(member->subsystem.id)) member->brought = fresh->brought;
    take_texts(craft_, file_, text_, std::move(texts_));
    craft_.tell(fmt::format("{}: the text is the one in force", file_.string()), apid_);
    return finish();
  }
  DescriptorProblems problems;
  fresh_.clear();
  declared_.clear();
  for (const descriptor::MissionSubsystem* member : flown) {
    const auto* fresh = reading.mission.value->find_subsystem(member->subsystem.id);
    if (fresh == nullptr || fresh->subsystem.name != member->subsystem.name) {
      problems.push_back({.file = file_,
                          .at = {},
                          .code = not_in_flight,
                          .message = "name or id of " + member->subsystem.name + " cannot change in flight",
                          .hint = "everybody knows it by them"});
      continue;
    }
    descriptor::MissionSubsystem& kept = fresh_.emplace(member->subsystem.id, *fresh).first->second;
    declared_.emplace(member->subsystem.id, kept.subsystem);
    compare(*member, kept, problems);
  }
  if (!problems.empty()) return refuse(problems);
  const auto memory = sealed(craft_.platform.memory, *text_);
  if (!memory) return give_up(FailureCode::CapacityExceeded, memory.error().text, memory.error().value);
  phase_ = Phase::Judging;
  hold(true);
  std::array<std::byte, 4> octets;
  OctetWriter{octets}.put(static_cast<std::uint32_t>(text_->size()));
  ask(DescriptorService::judge_text, octets, *memory);
}

void Descriptors::compare(const descriptor::MissionSubsystem& flown, descriptor::MissionSubsystem& fresh,
                          DescriptorProblems& problems) const {
  add_obstacles(problems, file_, descriptor::obstacles(flown.subsystem, fresh.subsystem));
  carry_values(flown, fresh, problems);
  const Member* member = std::as_const(craft_).member(flown.subsystem.id);
  if (member == nullptr || !member->alive()) return;
  if (const auto* configuration = flown.subsystem.find_configuration(member->configuration()))
    for (const auto& obstacle : descriptor::obstacles_in_force(flown.subsystem, fresh.subsystem, configuration->id))
      add_problem(problems, file_, obstacle.at,
                  fmt::format("{}: {} cannot change now", flown.subsystem.name, obstacle.what), obstacle.why);
  if (const std::string shut = craft_.launcher.shut_out(member->process(), flown, fresh); !shut.empty())
    add_problem(problems, file_, {}, fmt::format("{} cannot reach {}", flown.subsystem.name, shut),
                "its sandbox was made when its process started");
}

/// Everybody who runs. Who is down begins with what is in force then.
void Descriptors::ask(std::uint8_t subtype, Octets data, const MemoryHandle& text) {
  asked_.clear();
  for (const auto& [apid, fresh] : fresh_)
    if (const Member& member = *craft_.member(apid); member.alive())
      asked_[apid] = {.answer = Answer::Open, .why = {}, .process = member.process()};
  ++round_;
  for (const auto& [apid, asked] : std::map{asked_})
    parts_.desk.send(
        apid, DescriptorService::service_type, subtype, data, text,
        [this, member = apid, round = round_](bool success, const std::string& why) {
          if (round != round_) return;
          const auto found = asked_.find(member);
          if (found == asked_.end()) return;
          found->second.answer = success ? Answer::Yes : why == "no answer" ? Answer::None : Answer::No;
          found->second.why = why;
        },
        Duration{0});
}

void Descriptors::judged() {
  for (const auto& [apid, asked] : asked_)
    if (asked.answer != Answer::Yes && craft_.member(apid)->alive())
      return refuse({{.file = file_,
                      .at = {},
                      .code = not_in_flight,
                      .message = craft_.name_of(apid) + " does not take it: " + asked.why,
                      .hint = {}}});
  // Before anybody takes it: who has an address that it does not reach could not be configured.
  if (const DescriptorProblems problems = let_in(); !problems.empty()) return refuse(problems);
  phase_ = Phase::Taking;
  ask(DescriptorService::take_text, {}, {});
}

DescriptorProblems Descriptors::let_in() {
  DescriptorProblems problems;
  for (const auto& [apid, fresh] : fresh_) {
    const Member& member = *craft_.member(apid);
    if (!member.alive()) continue;
    if (const std::string shut = craft_.launcher.let_in(member.process(), fresh); !shut.empty())
      add_problem(problems, file_, {}, fmt::format("{} cannot be let in to {}", craft_.name_of(apid), shut),
                  "end who uses it and remove it, or begin a new flight");
  }
  return problems;
}

/// What nobody flies by any more is out of reach, whether that is what was there before or what was not taken.
void Descriptors::let_go() {
  for (const descriptor::MissionSubsystem* flown : flying(file_)) {
    const Member& member = *craft_.member(flown->subsystem.id);
    if (!member.alive()) continue;
    if (const std::string kept = craft_.launcher.keep_in(member.process(), *flown); !kept.empty())
      craft_.tell(fmt::format("{} reaches what its descriptor does not name, until its process ends: {}",
                              craft_.name_of(member.apid()), kept),
                  member.apid());
  }
}

/// Who has it, or may have it, must not be the only one.
void Descriptors::taken() {
  const bool somebody = asked_.empty() || std::ranges::any_of(asked_, [&](const auto& each) {
                          return each.second.answer != Answer::No || !craft_.member(each.first)->alive();
                        });
  if (!somebody)
    return refuse(
        {{.file = file_,
          .at = {},
          .code = not_in_flight,
          .message = craft_.name_of(asked_.begin()->first) + " did not take it: " + asked_.begin()->second.why,
          .hint = {}}});
  take_over();
  for (const descriptor::MissionSubsystem* flown : flying(file_)) {
    const std::uint16_t apid = flown->subsystem.id;
    const Member& member = *craft_.member(apid);
    const auto asked = asked_.find(apid);
    const bool has_it = asked != asked_.end() && asked->second.answer == Answer::Yes;
    if (!member.alive() || (has_it && asked->second.process == member.process())) continue;
    craft_.tell(craft_.name_of(apid) + " does not say that it took its descriptor: its process is ended", apid);
    craft_.launcher.kill(member.process());
  }
  finish();
}

void Descriptors::take_over() {
  for (descriptor::MissionSubsystem* member : flying(file_)) {
    auto fresh = fresh_.extract(member->subsystem.id);
    parts_.stored.redeclared(declared_.at(member->subsystem.id));
    put_in_force(craft_, parts_.own, *member, std::move(fresh.mapped()), *text_);
  }
  take_texts(craft_, file_, text_, std::move(texts_));
}

void Descriptors::refuse(const DescriptorProblems& problems) {
  tell_problems(craft_, parts_.own, apid_, call_ ? call_->request.source : std::uint16_t{0}, problems);
  give_up(FailureCode::ValueNotAcceptable,
          "problems, each in a TM[129,10]:", static_cast<std::int64_t>(problems.size()));
}

void Descriptors::finish() {
  hold(false);
  let_go();
  phase_ = Phase::Idle;
  asked_.clear();
  ++round_;
  if (const auto call = std::exchange(call_, std::nullopt)) parts_.own.finish(*call);
}

void Descriptors::give_up(FailureCode code, const char* words, std::int64_t number) {
  hold(false);
  let_go();
  phase_ = Phase::Idle;
  asked_.clear();
  ++round_;
  if (const auto call = std::exchange(call_, std::nullopt)) parts_.own.abort(*call, code, words, number);
}

/// What would be judged by the old text and done by the new one waits for the end.
void Descriptors::hold(bool held) {
  for (Member& member : craft_.members)
    if (member.descriptor().file == file_) member.descriptor_changes = held;
}

}  // namespace hirosco::supervisor
