// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/told_ends.hpp"

#include <algorithm>

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::communication {
namespace {

/// Rejected, not begun, completed, failed, not routed; 6 is of a step, and the execution may go on.
[[nodiscard]] constexpr bool is_end(std::uint8_t subtype) noexcept {
  return subtype == 2 || subtype == 4 || subtype == 7 || subtype == 8 || subtype == 10;
}

}  // namespace

void ToldEnds::went_up(Octets telecommand) noexcept {
  const auto read = pus::TelecommandView::parse(telecommand);
  if (read) std::ranges::replace(ends_, End{read->request_id(), read->source()}, End{});
}

bool ToldEnds::goes_down(Octets report) noexcept {
  const auto read = pus::TelemetryView::parse(report);
  if (!read || read->service() != 1 || !is_end(read->subtype())) return true;
  OctetReader reader{read->source_data()};
  const End end{reader.get<std::uint32_t>(), read->destination()};
  const auto code = static_cast<pus::FailureCode>(read->subtype() == 8 ? reader.get<std::uint16_t>() : 0);
  if (!reader.good()) return true;
  if (code == pus::FailureCode::OutcomeUnknown && std::ranges::find(ends_, end) != ends_.end()) return false;
  ends_[next_++ % most] = end;
  return true;
}

}  // namespace hirosco::communication
