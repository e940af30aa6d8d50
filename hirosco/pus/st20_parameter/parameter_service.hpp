// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <span>
#include <vector>

#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::pus {

/// What ST[20] needs of the parameters; ranges, states and protections are judged by who implements it (`ParameterValues::check_write()`). Ids are ParameterId::wire(); values are big-endian as on the wire.
/// Thread: that of the service's loop.
struct ParameterAccess {
  struct Write {
    std::uint32_t id{};
    Octets value;  ///< views the telecommand: copy it before returning
  };
  virtual ~ParameterAccess() = default;
  /// Called once before the reads of one report: they all see the values of one cycle.
  virtual void begin_report() {}
  /// Octets written.
  [[nodiscard]] virtual std::expected<std::size_t, ErrorCode> read(std::uint32_t parameter_id, MutableOctets value) = 0;
  /// 0: unknown.
  [[nodiscard]] virtual std::size_t size_of(std::uint32_t parameter_id) = 0;
  /// Whether this value may be written; `value` has size_of() octets.
  [[nodiscard]] virtual std::expected<void, FailureCode> check_write(std::uint32_t parameter_id, Octets value) = 0;
  /// Queues checked writes so that all take effect together at one cycle boundary. Busy: no room now; CapacityExceeded: there
  /// is never room for so many; nothing is queued then. Else it is a promise: the service reports start and completion itself.
  [[nodiscard]] virtual std::expected<void, FailureCode> submit_write(std::span<const Write> writes,
                                                                      const Request& request) = 0;
};

/// ST[20]: reports and sets parameter values (ECSS-E-ST-70-41C 8.20.2; README.md); of one request all are set, or none.
/// Thread: the service loop, or a loop of its own (docs/adr/0200).
class ParameterService final : public Service {
 public:
  static constexpr std::uint8_t service_type = 20;
  enum Subtype : std::uint8_t { report_values = 1, value_report = 2, set_values = 3 };

  ParameterService(ParameterAccess& access, Verification& verification, TelemetrySink& sink)
      : access_{access}, verification_{verification}, sink_{sink} {}
  static const ServiceKind service_kind;
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override;

 private:
  void report(Octets data, const Request& request);
  void set(Octets data, const Request& request);
  void execute_writes(std::span<const ParameterAccess::Write> asked, const Request& request);

  ParameterAccess& access_;
  Verification& verification_;
  TelemetrySink& sink_;
};

}  // namespace hirosco::pus
