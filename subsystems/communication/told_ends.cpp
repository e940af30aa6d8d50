// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/told_ends.hpp"

#include <algorithm>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/crc32.hpp"

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
  const auto header = pus::read_primary_header(telecommand);
  if (!header) return;
  End& before = place_of(header->request_id);
  const auto read = pus::TelecommandView::parse(telecommand);
  if (!read) {
    if (before.request == header->request_id) before = {};
    return;
  }
  End end{.request = header->request_id, .source = read->source(), .went_up = true, .due = 1, .told = 0};
  // Two clients that count alike: each has an end.
  if (before.is_of(end)) end.due = static_cast<std::uint8_t>(std::min(before.due + 1, 255));
  before = end;
}

bool ToldEnds::goes_down(Octets report) noexcept {
  const auto read = pus::TelemetryView::parse(report);
  if (!read || read->service() != 1 || !is_end(read->subtype())) return true;
  OctetReader reader{read->source_data()};
  End end{.request = reader.get<std::uint32_t>(), .source = read->destination(), .went_up = false, .due = 0, .told = 0};
  const auto code = static_cast<pus::FailureCode>(read->subtype() == 8 ? reader.get<std::uint16_t>() : 0);
  if (!reader.good()) return true;
  end.told = (std::uint64_t{read->subtype()} << 32U) | crc32(read->source_data());
  End& before = place_of(end.request);
  if (before.is_of(end)) {
    if (code == pus::FailureCode::OutcomeUnknown && before.told != 0 && before.due == 0) return false;
    if (read->apid() == pus::supervisor_apid && before.went_up && before.due == 0 && before.told == end.told)
      return false;
    end.went_up = before.went_up;
    end.due = static_cast<std::uint8_t>(std::max(before.due - 1, 0));
  }
  before = end;
  return true;
}

}  // namespace hirosco::communication
