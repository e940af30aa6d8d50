// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/unanswered.hpp"

#include <algorithm>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::supervisor {

namespace {
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
  return static_cast<std::size_t>(std::ranges::count_if(
      entries_, [&](const Entry& entry) { return entry.request.source == source && now - entry.since < patience; }));
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
  if (final || (found->request.ack & pus::ack_completion) == 0) entries_.erase(found);
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
