// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/pus/st01_verification/verification.hpp"

namespace hirosco::pus {

/// ST[17]: answers "are you alive" (pus-c 11.1). The on-board connection test TC[17,3] is the supervisor's.
/// Thread: the service loop.
class TestService final : public Service {
 public:
  static constexpr std::uint8_t service_type = 17;
  enum Subtype : std::uint8_t { are_you_alive = 1, alive_report = 2 };

  TestService(Verification& verification, TelemetrySink& sink) : verification_{verification}, sink_{sink} {}
  static const ServiceKind service_kind;
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override;

 private:
  Verification& verification_;
  TelemetrySink& sink_;
};

}  // namespace hirosco::pus
