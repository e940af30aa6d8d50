// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st17_test/self_test.hpp"
#include "hirosco/utilities/os/clock.hpp"

namespace hirosco {

/// What the service loop knows of the author's self test: who asked for it, and how the newest one ended (adr 0073). Whether
/// a pass is in force says the cycle.  Thread: the service loop.
class SelfTests {
 public:
  SelfTests(pus::Verification& verification, pus::TelemetrySink& sink, const Clock& clock)
      : verification_{verification}, sink_{sink}, clock_{clock} {}

  [[nodiscard]] bool running() const noexcept { return asked_.has_value(); }
  /// The cycle was told to run it.
  void begun(const pus::Request& request);
  /// The cycle says how; `code` 0: passed.
  void ended(const pus::Request& request, std::uint16_t code, const pus::Reason& why);
  /// A configuration was put in force: in it none has run.
  void applied(std::uint8_t configuration);
  /// It is given back: one that still runs ends as aborted.
  void abandon();

  [[nodiscard]] pus::SelfTestRecord record(bool passed) const;
  /// Why SET_STATE Operational is refused; nothing where it is not. `passed`: a pass is in force.
  [[nodiscard]] std::optional<pus::FailureNotice> keeps_from_operational(const descriptor::Configuration& configuration,
                                                                         bool passed) const;

 private:
  void tell(const pus::Request& request);

  pus::Verification& verification_;
  pus::TelemetrySink& sink_;
  const Clock& clock_;
  pus::SelfTestRecord newest_{};
  std::optional<pus::Request> asked_;
};

}  // namespace hirosco
