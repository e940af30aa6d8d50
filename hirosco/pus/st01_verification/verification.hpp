// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/service/service.hpp"

namespace hirosco::pus {

/// ST[01]: reports the stages of a request; success only if asked for, failure always (ECSS-E-ST-70-41C 8.1.2; README.md).
/// Thread: the service loop.
class Verification {
 public:
  static constexpr std::uint8_t service_type = 1;
  static const ServiceKind service_kind;
  explicit Verification(TelemetrySink& sink) : sink_{sink} {}
  void accepted(const Request& request);  ///< TM[1,1]
  void rejected(const Request& request, const FailureNotice& notice);  ///< TM[1,2]
  void started(const Request& request);  ///< TM[1,3]
  void start_failed(const Request& request, const FailureNotice& notice);  ///< TM[1,4]
  void progressed(const Request& request, std::uint16_t step);  ///< TM[1,5]
  void progress_failed(const Request& request, std::uint16_t step, const FailureNotice& notice);  ///< TM[1,6]
  void completed(const Request& request);  ///< TM[1,7]
  void completion_failed(const Request& request, const FailureNotice& notice);  ///< TM[1,8]
  void routing_failed(const Request& request, const FailureNotice& notice);  ///< TM[1,10]

 private:
  void send(std::uint8_t subtype, const Request& request, const std::uint16_t* step, const FailureNotice* notice);
  TelemetrySink& sink_;
};

}  // namespace hirosco::pus
