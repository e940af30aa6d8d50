// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/unanswered.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "hirosco/subsystem/author/request_port.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco::supervisor {

namespace {
/// Of the supervisor's own telecommands.
constexpr std::uint16_t own_source = pus::supervisor_apid;

[[nodiscard]] constexpr bool is_end(std::uint8_t subtype) noexcept {
  const bool failed_progress = subtype == 6;  // the execution may go on
  return (subtype % 2 == 0 && !failed_progress) || subtype == 7;
}
}  // namespace

void Unanswered::forwarded(std::uint16_t apid, const pus::TelecommandView& telecommand, TimePoint now) {
  const pus::Request request = pus::request_of(telecommand);
  if ((request.ack & (pus::ack_acceptance | pus::ack_completion)) == 0 || full()) return;
  entries_.push_back({.apid = apid, .request = request, .since = now});
}

bool Unanswered::answers(const pus::TelemetryView& report) {
  const bool verification = report.service() == 1;
  const auto id = OctetReader{report.source_data()}.get<std::uint32_t>();
  const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
    return entry.apid == report.apid() && entry.request.source == report.destination() &&
           (!verification || entry.request.id == id);
  });
  if (found == entries_.end()) return false;
  return (verification && is_end(report.subtype())) || found->reports++ < most_reports;
}

std::size_t Unanswered::count_of(std::uint16_t source, TimePoint now) const {
  return static_cast<std::size_t>(std::ranges::count_if(entries_, [&](const Entry& entry) {
    return entry.request.source == source && entry.before == Before::Nothing && now - entry.since < request_patience;
  }));
}

void Unanswered::reported(const pus::TelemetryView& report) {
  if (report.service() != 1) return;
  OctetReader reader{report.source_data()};
  const auto id = reader.get<std::uint32_t>();
  if (!reader.good()) return;
  const bool final = is_end(report.subtype());
  const bool accepted = report.subtype() == 1;
  const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
    return entry.apid == report.apid() && entry.request.id == id && entry.request.source == report.destination();
  });
  if (found == entries_.end()) return;
  if (found->before == Before::Leaving) found->before = Before::Left;  // its addressee has it
  if (!final && !accepted) return;
  if (!final && (found->request.ack & pus::ack_completion) != 0) return;
  settled_.push_back(*found);
  entries_.erase(found);
}

void Unanswered::note(OctetWriter& writer) const {
  // Nobody asks again for the end of the supervisor's own that has had one.
  const auto others = [](const Entry& entry) { return entry.request.source != own_source; };
  const auto put = [&](const Entry& entry) {
    writer.put(entry.apid).put(entry.request.id).put(entry.request.source).put(entry.request.ack);
  };
  for (const Before kind : noted) {
    const auto is_kind = [&](const Entry& entry) {
      return (entry.before == Before::Nothing ? Before::Left : entry.before) == kind;
    };
    auto count = std::ranges::count_if(entries_, is_kind);
    if (kind == Before::Ended) count += std::ranges::count_if(settled_, others);
    writer.put(static_cast<std::uint16_t>(count));
    std::ranges::for_each(entries_ | std::views::filter(is_kind), put);
    if (kind == Before::Ended) std::ranges::for_each(settled_ | std::views::filter(others), put);
  }
  writer.put(static_cast<std::uint16_t>(senders_.size()));
  for (const auto& [apid, sender] : senders_) writer.put(apid).put(sender.count);
}

void Unanswered::recall(OctetReader& reader) {
  for (const Before kind : noted)
    for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
      Entry entry;
      entry.before = kind;
      entry.apid = reader.get<std::uint16_t>();
      entry.request.id = reader.get<std::uint32_t>();
      entry.request.source = reader.get<std::uint16_t>();
      entry.request.ack = reader.get<std::uint8_t>();
      if (reader.good()) entries_.push_back(entry);
    }
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    const auto apid = reader.get<std::uint16_t>();
    senders_[apid] = {reader.get<std::uint16_t>(), true, std::nullopt};
  }
}

std::vector<pus::Request> Unanswered::take_settled() {
  std::vector<pus::Request> taken;
  std::erase_if(entries_, [&](const Entry& entry) {
    if (entry.before != Before::Ended) return false;
    taken.push_back(entry.request);
    return true;
  });
  return taken;
}

void Unanswered::counted(std::uint16_t apid, std::uint16_t count, TimePoint now) {
  Sender& sender = senders_[apid];
  const bool next = count == (sender.count + 1) % pus::sequence_counts;
  if (std::exchange(sender.recalled, false) && !next) sender.lost_at = now;
  sender.count = count;
}

void Unanswered::was_leaving(std::uint16_t apid, const pus::Request& request) {
  entries_.push_back({.apid = apid, .request = request, .before = Before::Leaving});
}

template <class Which>
void Unanswered::take_as_unknown(const Which& which, std::vector<pus::Request>& taken) {
  std::erase_if(entries_, [&](const Entry& entry) {
    if (!which(entry)) return false;
    taken.push_back(entry.request);
    if (told_.size() == most_told) told_.pop_front();
    told_.push_back(entry);
    return true;
  });
}

std::vector<pus::Request> Unanswered::take_doubtful(TimePoint now) {
  std::vector<pus::Request> taken;
  for (auto& [apid, sender] : senders_) {
    if (!sender.lost_at || now - *sender.lost_at < doubt) continue;
    sender.lost_at.reset();
    take_as_unknown([&](const Entry& entry) { return entry.apid == apid && entry.before != Before::Nothing; }, taken);
  }
  if (hears_from_ && now - *hears_from_ >= doubt) {
    hears_from_.reset();
    take_as_unknown([](const Entry& entry) { return entry.before == Before::Leaving; }, taken);
  }
  return taken;
}

bool Unanswered::contradicts(const pus::TelemetryView& report) const {
  if (told_.empty() || report.service() != 1 || !is_end(report.subtype())) return false;
  const auto id = OctetReader{report.source_data()}.get<std::uint32_t>();
  return std::ranges::any_of(told_, [&](const Entry& entry) {
    return entry.apid == report.apid() && entry.request.id == id && entry.request.source == report.destination();
  });
}

std::vector<pus::Request> Unanswered::take(std::uint16_t apid) {
  std::vector<pus::Request> taken;
  std::erase_if(entries_, [&](const Entry& entry) {
    if (entry.apid != apid) return false;
    taken.push_back(entry.request);
    return true;
  });
  return taken;
}

}  // namespace hirosco::supervisor
