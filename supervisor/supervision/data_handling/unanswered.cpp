// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/unanswered.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::supervisor {

namespace {
/// Of the supervisor's own telecommands.
constexpr std::uint16_t own_source = pus::supervisor_apid;
/// In the place of a number of reports: its end was heard by a supervisor that died before it could be told.
constexpr std::uint16_t unsaid = 0xFFFF;

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
    return entry.request.source == source && entry.apid != own_source && !entry.recalled &&
           now - entry.since < patience;
  }));
}

void Unanswered::reported(const pus::TelemetryView& report) {
  if (report.service() != 1) return;
  OctetReader reader{report.source_data()};
  const auto id = reader.get<std::uint32_t>();
  if (!reader.good()) return;
  const bool final = is_end(report.subtype());
  const bool accepted = report.subtype() == 1;
  if (!final && !accepted) return;
  const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
    return entry.apid == report.apid() && entry.request.id == id && entry.request.source == report.destination();
  });
  if (found == entries_.end()) return;
  if (!final && (found->request.ack & pus::ack_completion) != 0) return;
  settled_.push_back(*found);
  entries_.erase(found);
}

void Unanswered::note(OctetWriter& writer) const {
  const auto waits = [](const Entry& entry) { return entry.request.source != own_source && entry.reports != unsaid; };
  const auto ended = [](const Entry& entry) { return entry.request.source != own_source && entry.reports == unsaid; };
  const auto heard = [](const Entry& entry) { return entry.request.source != own_source; };
  const auto put = [&](const auto& entries, const auto& which) {
    for (const Entry& entry : entries)
      if (which(entry)) writer.put(entry.apid).put(entry.request.id).put(entry.request.source).put(entry.request.ack);
  };
  writer.put(static_cast<std::uint16_t>(std::ranges::count_if(entries_, waits)));
  put(entries_, waits);
  writer.put(
      static_cast<std::uint16_t>(std::ranges::count_if(entries_, ended) + std::ranges::count_if(settled_, heard)));
  put(entries_, ended);
  put(settled_, heard);
  writer.put(static_cast<std::uint16_t>(senders_.size()));
  for (const auto& [apid, sender] : senders_) writer.put(apid).put(sender.count);
}

void Unanswered::recall(OctetReader& reader) {
  for (const std::uint16_t reports : {std::uint16_t{0}, unsaid})
    for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
      Entry entry;
      entry.recalled = true;
      entry.reports = reports;
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
    if (entry.reports != unsaid) return false;
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

std::vector<pus::Request> Unanswered::take_doubtful(TimePoint now) {
  std::vector<pus::Request> taken;
  for (auto& [apid, sender] : senders_) {
    if (!sender.lost_at || now - *sender.lost_at < doubt) continue;
    sender.lost_at.reset();
    std::erase_if(entries_, [&](const Entry& entry) {
      if (entry.apid != apid || !entry.recalled) return false;
      taken.push_back(entry.request);
      if (told_.size() == most_told) told_.pop_front();
      told_.push_back(entry);
      return true;
    });
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
