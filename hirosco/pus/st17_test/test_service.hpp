// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st17_test/self_test.hpp"

namespace hirosco::pus {

/// ST[17]: answers "are you alive" (ECSS-E-ST-70-41C 8.17.2; README.md), and carries the self test of the subsystem's author, ours (adr 0073). The
/// on-board connection test TC[17,3] is not built in: it is refused with code 7.  Thread: the service loop.
///
///   TC[17,128]  run the self test, in Safe-Operational: TM[17,129], then TM[1,7] or TM[1,8] with the author's reason
///   TC[17,130]  tell the outcome of the newest one: TM[17,129]
class TestService final : public Service {
 public:
  static constexpr std::uint8_t service_type = 17;
  enum Subtype : std::uint8_t {
    are_you_alive = 1,
    alive_report = 2,
    run_self_test = 128,
    self_test_report = 129,
    report_self_test = 130
  };

  TestService(Verification& verification, TelemetrySink& sink, SelfTest& self_test)
      : verification_{verification}, sink_{sink}, self_test_{self_test} {}
  static const ServiceKind service_kind;
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override;

 private:
  Verification& verification_;
  TelemetrySink& sink_;
  SelfTest& self_test_;
};

}  // namespace hirosco::pus
