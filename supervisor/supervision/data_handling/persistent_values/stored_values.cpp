// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/stored_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "supervisor/supervision/data_handling/persistent_values/set_values.hpp"

namespace hirosco::supervisor {
namespace {

using Parameters = pus::ParameterService;

/// A write takes effect at the next cycle boundary, and a function may have come between two of them.
[[nodiscard]] Duration settling(const descriptor::SubsystemDescriptor& subsystem) {
  Duration longest{};
  for (const auto& configuration : subsystem.configurations) longest = std::max(longest, configuration.sampling);
  return 2 * longest;
}

}  // namespace

void StoredValues::begin() {
  news_.begin(craft_.now);
  for (descriptor::MissionSubsystem& member : craft_.mission.subsystems) {
    ValueSet values{member};
    const std::uint16_t apid = member.subsystem.id;
    if (!values.wanted()) continue;
    Subject& subject = subjects_.emplace(apid, Subject{&member, std::move(values)}).first->second;
    begin(apid, subject);
    if (const auto left = left_.find(apid); left != left_.end()) go_on(subject, left->second);
  }
  left_.clear();
}

void StoredValues::go_on(Subject& subject, const Left& left) {
  // The disk may have it all the same: nobody was told.
  if (left.unkept && left.unkept->sequence >= subject.sequence) {
    subject.sequence = left.unkept->sequence;
    if (subject.values.take(*left.unkept)) {
      subject.since = left.unkept->since;
      subject.values.begin(*subject.member);
      keep(subject);
    } else {
      own_.announce("VALUES_NOT_KEPT", {static_cast<double>(subject.member->subsystem.id)});
    }
  }
  ask_later(subject, left.changed);
}

void StoredValues::begin(std::uint16_t apid, Subject& subject) {
  if (store_ == nullptr) return;
  const std::string& name = subject.member->subsystem.name;
  const TwoCopies copies = store_->read(name);
  const auto missing = [&](std::size_t i) { return !copies[i] && copies[i].error() == CopyFault::Missing; };
  if (missing(0) && missing(1)) return;
  bool heal = false;
  for (std::size_t i = 0; i < copies.size(); ++i) {
    if (copies[i]) subject.sequence = std::max(subject.sequence, copies[i]->sequence);
    else news_.refused(apid, i + 1, copies[i].error());
    heal = heal || !copies[i];
  }
  std::array<std::size_t, 2> order{0, 1};
  if (copies[0] && copies[1] && copies[1]->sequence > copies[0]->sequence) order = {1, 0};
  for (const std::size_t i : order) {
    if (!copies[i]) continue;
    if (const auto taken = subject.values.take(*copies[i]); !taken) {
      news_.refused(apid, i + 1, taken.error());
      continue;
    }
    const bool behind = !copies[1 - i] || copies[1 - i]->sequence != copies[i]->sequence;
    subject.since = copies[i]->since;
    subject.values.begin(*subject.member);
    craft_.tell(fmt::format("{} takes over {} stored value{}, of {}", name, subject.values.size(),
                            subject.values.size() == 1 ? "" : "s", time_text(subject.since)),
                apid);
    news_.taken(apid, subject.values.size(), subject.since);
    // The one that was not whole, or not as new, must not stay the only other one.
    if (heal || behind) keep(subject);
    return;
  }
  craft_.tell(name + " begins as its descriptor says: none of its stored values is used", apid);
}

void StoredValues::forwarded(std::uint16_t apid, const pus::TelecommandView& telecommand) {
  const auto subject = subjects_.find(apid);
  if (subject == subjects_.end()) return;
  Ids ids = set_by(telecommand, subject->second.member->subsystem, subject->second.values);
  if (ids.empty()) return;
  const pus::Request request = pus::request_of(telecommand);
  AwaitedChanges::Change change{apid, request.id, request.source, ids};
  const Octets data = telecommand.application_data();
  if (sets_values(telecommand)) change.values.assign(data.begin(), data.end());
  if ((telecommand.ack() & pus::ack_completion) == 0 || !awaited_.add(std::move(change)))
    ask_later(subject->second, ids);
}

void StoredValues::hear(std::uint16_t from, const pus::TelemetryView& report) {
  if (report.service() == 1) return hear_end(from, report);
  const auto subject = subjects_.find(from);
  if (subject == subjects_.end()) return;
  if (report.service() == Parameters::service_type && report.subtype() == Parameters::value_report &&
      report.destination() == supervisor_apid)
    take_report(subject->second, report.source_data());
}

void StoredValues::hear_end(std::uint16_t from, const pus::TelemetryView& report) {
  const bool failed = report.subtype() % 2 == 0 && report.subtype() != 6;
  if (!failed && report.subtype() != 7) return;
  if (from == supervisor_apid) {
    // Its end went with the supervisor before, or is still to come.
    if (const auto* unknown = awaited_.told_as_unknown(report))
      if (const auto subject = subjects_.find(unknown->apid); subject != subjects_.end())
        ask_later(subject->second, unknown->ids);
    return;
  }
  const auto subject = subjects_.find(from);
  if (subject == subjects_.end()) return;
  const auto ended = awaited_.take(from, report);
  if (!ended) return;
  if (!failed && !ended->values.empty()) return take_write(subject->second, ended->values);
  // A function that failed on its way may have set it before.
  const bool may_have_begun = report.subtype() == 7 || report.subtype() == 8;
  if (ended->values.empty() && may_have_begun) ask_later(subject->second, ended->ids);
}

void StoredValues::take_write(Subject& subject, Octets data) {
  bool news = false;
  Ids set;
  Ids in_part;
  each_value(subject.member->subsystem, data, [&](std::uint32_t id, Octets value) {
    news = subject.values.set(id, value) || news;
    set.insert(id);
    if (const auto owner = owner_of(subject.member->subsystem, id); owner != id) in_part.insert(owner);
  });
  // What was asked for may have been told before this took effect.
  if (std::ranges::any_of(set,
                          [&](std::uint32_t id) { return subject.changed.contains(id) || subject.asked.contains(id); }))
    ask_later(subject, set);
  // A structure is kept whole: what the rest of it is now says itself.
  if (!in_part.empty()) ask_later(subject, in_part);
  if (news) changed(subject);
}

void StoredValues::take_report(Subject& subject, Octets data) {
  bool news = false;
  each_value(subject.member->subsystem, data, [&](std::uint32_t id, Octets value) {
    if (subject.asked.erase(id) != 0) news = subject.values.set(id, value) || news;
  });
  if (news) changed(subject);
}

void StoredValues::ask_later(Subject& subject, const Ids& ids) {
  for (const std::uint32_t id : ids) {
    if (!subject.values.has(id)) continue;
    subject.asked.erase(id);
    subject.changed.insert(id);
  }
  subject.ask_at = craft_.now + settling(subject.member->subsystem);
}

void StoredValues::ask(std::uint16_t apid, Subject& subject) {
  const Member* member = craft_.member(apid);
  // In Offline it has no parameters to be asked for; what it was left with it begins with.
  if (member == nullptr || !member->alive() || member->state() == descriptor::State::Offline) return;
  std::vector<std::byte> data(1 + sizeof(std::uint32_t) * subject.changed.size());
  OctetWriter writer{data};
  writer.put(static_cast<std::uint8_t>(subject.changed.size()));
  for (const std::uint32_t id : subject.changed) writer.put(id);
  subject.asked.merge(subject.changed);
  subject.changed.clear();
  desk_.send(
      apid, Parameters::service_type, Parameters::report_values, data, {},
      [this, apid](bool, const std::string&) {
        // What it did not tell is asked for again.
        if (const auto found = subjects_.find(apid); found != subjects_.end() && !found->second.asked.empty())
          ask_later(found->second, Ids{found->second.asked});
      },
      Duration{0});
}

void StoredValues::redeclared(const descriptor::SubsystemDescriptor& subsystem) {
  const auto found = subjects_.find(subsystem.id);
  if (found == subjects_.end()) return;
  // Of one that is read in flight the ranges hold what was set; of one that is gone back to they may not.
  const auto forgotten = found->second.values.redeclare(subsystem);
  if (forgotten.empty()) return;
  craft_.tell(fmt::format("stored values of {} leave their ranges: {}", subsystem.name, fmt::join(forgotten, ", ")),
              subsystem.id);
  own_.announce("VALUES_NOT_KEPT", {static_cast<double>(subsystem.id)});
  changed(found->second);
}

void StoredValues::undo(descriptor::SubsystemDescriptor& subsystem) const {
  if (const auto found = subjects_.find(subsystem.id); found != subjects_.end()) found->second.values.undo(subsystem);
}

void StoredValues::ended(std::uint16_t apid) {
  const auto found = subjects_.find(apid);
  if (found == subjects_.end()) return;
  Subject& subject = found->second;
  subject.changed.merge(awaited_.take_all_of(apid));
  subject.changed.merge(subject.asked);
  subject.asked.clear();
  bool forgot = false;
  for (const std::uint32_t id : std::exchange(subject.changed, {})) {
    if (!subject.values.forget(id)) continue;
    forgot = true;
    craft_.tell(fmt::format("what {} made of {} is not known: it begins as the descriptor says",
                            subject.member->subsystem.name, subject.values.name_of(id)),
                apid);
  }
  if (!forgot) return;
  own_.announce("VALUES_NOT_KEPT", {static_cast<double>(apid)});
  changed(subject);
}

void StoredValues::changed(Subject& subject) {
  ++subject.sequence;
  subject.since = craft_.platform.clock.onboard();
  subject.values.begin(*subject.member);
  keep(subject);
}

void StoredValues::keep(Subject& subject) {
  if (store_ == nullptr) return;
  subject.waits = true;
  store_->keep(subject.member->subsystem.name, subject.values.copy(subject.sequence, subject.since));
}

void StoredValues::watch(TimePoint now) {
  news_.tell(now);
  for (auto& [apid, subject] : subjects_) {
    if (!subject.changed.empty() && now >= subject.ask_at) ask(apid, subject);
    if (!subject.failing || now < subject.retry_at) continue;
    subject.retry_at = now + retry_after;
    keep(subject);
  }
  if (store_ != nullptr) take_outcomes(now);
}

void StoredValues::take_outcomes(TimePoint now) {
  for (const KeptOutcome& outcome : store_->take_outcomes())
    for (auto& [apid, subject] : subjects_) {
      if (subject.member->subsystem.name != outcome.subsystem || outcome.sequence != subject.sequence) continue;
      const bool failed = outcome.failure.has_value();
      subject.retry_at = now + retry_after;
      if (!failed) {
        subject.waits = false;
        own_.announce("VALUES_KEPT", {static_cast<double>(apid), static_cast<double>(subject.values.size())});
      } else if (!subject.failing) {
        craft_.tell(fmt::format("{}'s values are not stored: {} ({})", outcome.subsystem, outcome.failure->text,
                                outcome.failure->value),
                    apid);
        own_.announce("VALUES_NOT_KEPT", {static_cast<double>(apid)});
      }
      subject.failing = failed;
    }
}

void StoredValues::note(OctetWriter& writer) const {
  const auto is_under_way = [](const auto& entry) {
    return entry.second.waits || !entry.second.changed.empty() || !entry.second.asked.empty();
  };
  const auto put = [&writer](std::uint16_t apid, const Ids& changed, const Ids& asked, const ValueCopy* unkept) {
    writer.put(apid).put(static_cast<std::uint16_t>(changed.size() + asked.size()));
    for (const Ids* ids : {&changed, &asked})
      for (const std::uint32_t id : *ids) writer.put(id);
    const auto copy = unkept != nullptr ? write_copy(*unkept) : std::vector<std::byte>{};
    writer.put(static_cast<std::uint16_t>(copy.size())).put(Octets{copy});
  };
  // Of the supervisor before, until begin() has gone on with it.
  writer.put(static_cast<std::uint16_t>(std::ranges::count_if(subjects_, is_under_way) +
                                        static_cast<std::ptrdiff_t>(left_.size())));
  for (const auto& [apid, left] : left_) put(apid, left.changed, {}, left.unkept ? &*left.unkept : nullptr);
  for (const auto& entry : subjects_) {
    if (!is_under_way(entry)) continue;
    const auto& [apid, subject] = entry;
    const auto unkept =
        subject.waits ? std::optional{subject.values.copy(subject.sequence, subject.since)} : std::nullopt;
    put(apid, subject.changed, subject.asked, unkept ? &*unkept : nullptr);
  }
  awaited_.note(writer);
}

void StoredValues::recall(OctetReader& reader) {
  for (auto subjects = reader.get<std::uint16_t>(); subjects > 0 && reader.good(); --subjects) {
    Left& left = left_[reader.get<std::uint16_t>()];
    for (auto ids = reader.get<std::uint16_t>(); ids > 0 && reader.good(); --ids)
      left.changed.insert(reader.get<std::uint32_t>());
    if (const auto copy = read_copy(reader.get(reader.get<std::uint16_t>()))) left.unkept = *copy;
  }
  awaited_.recall(reader);
}

}  // namespace hirosco::supervisor
