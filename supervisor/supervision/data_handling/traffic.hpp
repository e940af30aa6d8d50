// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "hirosco/pus/packet/failure_code.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// What has come by, for housekeeping: how many packets, and why telecommands were not carried out, whoever said so.
class Traffic final : public Hearer {
 public:
  /// As the supervisor's parameter COUNTS has it.
  struct Counts {
    std::uint32_t telecommands{0};
    std::uint32_t telemetry{0};
    std::uint32_t misdirected{0};        ///< packets that claimed another sender's APID
    std::uint32_t housekeeping_lost{0};  ///< on the way to the ground link, as the next
    std::uint32_t reports_lost{0};
  };
  /// A place for each code of the framework below those of services and authors, which share the first.
  static constexpr std::size_t reasons = [] {
    constexpr auto first_of_services = static_cast<std::uint16_t>(pus::FailureCode::UnknownIdentifier);
    std::uint16_t last = 0;
    for (const auto& row : EnumTexts<pus::FailureCode>::table)
      if (const auto code = static_cast<std::uint16_t>(row.value); code < first_of_services)
        last = std::max(last, code);
    return std::size_t{last} + 1;
  }();
  using Rejections = std::array<std::uint32_t, reasons>;

  /// Each failure report passes here.
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  void count_rejection(pus::FailureCode code) noexcept;
  [[nodiscard]] const Rejections& rejections() const noexcept { return rejections_; }

  Counts counts;

 private:
  Rejections rejections_{};
};

}  // namespace hirosco::supervisor
