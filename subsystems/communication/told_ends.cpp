// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/told_ends.hpp"

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::communication {
namespace {

/// Rejected, not begun, completed, failed, not routed; 6 is of a step, and the execution may go on.
[[nodiscard]] constexpr bool is_end(std::uint8_t subtype) noexcept {
  return subtype == 2 || subtype == 4 || subtype == 7 || subtype == 8 || subtype == 10;
}

}  // namespace

/// By the sequence count, so that those of one addressee follow each other; addressees, whose counts are often alike, lie far apart.
ToldEnds::End& ToldEnds::place_of(std::uint32_t request) noexcept {
  constexpr std::uint32_t apart = 0x35B;
  return ends_[(request ^ (request >> 16U) * apart) % kept];
}

void ToldEnds::went_up(Octets telecommand) noexcept {
  const auto read = pus::read_primary_header(telecommand);
  if (!read) return;
  if (End& before = place_of(read->request_id); before.request == read->request_id) before = {};
}

bool ToldEnds::goes_down(Octets report) noexcept {
  const auto read = pus::TelemetryView::parse(report);
  if (!read || read->service() != 1 || !is_end(read->subtype())) return true;
  OctetReader reader{read->source_data()};
  const End end{reader.get<std::uint32_t>(), read->destination()};
  const auto code = static_cast<pus::FailureCode>(read->subtype() == 8 ? reader.get<std::uint16_t>() : 0);
  if (!reader.good()) return true;
  End& before = place_of(end.request);
  if (code == pus::FailureCode::OutcomeUnknown && before == end) return false;
  before = end;
  return true;
}

}  // namespace hirosco::communication
