// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/traffic.hpp"

namespace hirosco::supervisor {

void Traffic::hear(std::uint16_t, const pus::TelemetryView& report) {
  const bool failure = report.service() == 1 && report.subtype() % 2 == 0;
  if (!failure) return;
  OctetReader reader{report.source_data()};
  static_cast<void>(reader.get<std::uint32_t>());
  if (report.subtype() == 6) static_cast<void>(reader.get<std::uint16_t>());
  const auto code = static_cast<pus::FailureCode>(reader.get<std::uint16_t>());
  if (reader.good()) count_rejection(code);
}

void Traffic::count_rejection(pus::FailureCode code) noexcept {
  const auto place = static_cast<std::size_t>(code);
  ++rejections_[place < reasons ? place : 0];
}

}  // namespace hirosco::supervisor
