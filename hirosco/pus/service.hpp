// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/pus/failure.hpp"
#include "hirosco/pus/packet.hpp"
#include "hirosco/utilities/octets.hpp"

/// What every PUS service is given and is: protocol logic without I/O.
namespace hirosco::pus {

/// Where a service puts its reports. The owner stamps APID, counts and time.  Thread: the service loop.
class TelemetrySink {
 public:
  virtual ~TelemetrySink() = default;
  virtual void report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination, Octets source_data) = 0;
};

/// What must be remembered of a request until its last report: trivially copyable, travels through the cycle's queues.
struct Request {
  std::uint32_t id{};                ///< first four octets of the telecommand
  std::uint16_t source{};            ///< becomes the destination of every report
  std::uint8_t ack{};                ///< which success reports were asked for
};

/// ST[01]: reports the stages of a request; success only if asked for, failure always (pus-c tailoring 5.1).
/// Thread: the service loop.
class Verification {
 public:
  explicit Verification(TelemetrySink& sink) : sink_{sink} {}
  void accepted(const Request& request);                                          ///< TM[1,1]
  void rejected(const Request& request, const FailureNotice& notice);             ///< TM[1,2]
  void started(const Request& request);                                           ///< TM[1,3]
  void start_failed(const Request& request, const FailureNotice& notice);         ///< TM[1,4]
  void progressed(const Request& request, std::uint16_t step);                    ///< TM[1,5]
  void progress_failed(const Request& request, std::uint16_t step, const FailureNotice& notice);  ///< TM[1,6]
  void completed(const Request& request);                                         ///< TM[1,7]
  void completion_failed(const Request& request, const FailureNotice& notice);    ///< TM[1,8]
  void routing_failed(const Request& request, const FailureNotice& notice);       ///< TM[1,10]

 private:
  void send(std::uint8_t subtype, const Request& request, const std::uint16_t* step, const FailureNotice* notice);
  TelemetrySink& sink_;
};

/// A PUS service of one application process. handle() is called with telecommands of its type only; it does the
/// acceptance checks from the subtype on (9 to 11) and reports every stage through the Verification it was made with.
/// Thread: the service loop.
class Service {
 public:
  virtual ~Service() = default;
  [[nodiscard]] virtual std::uint8_t type() const noexcept = 0;
  virtual void handle(const TelecommandView& telecommand, const Request& request) = 0;
};

[[nodiscard]] inline Request request_of(const TelecommandView& telecommand) noexcept {
  return {telecommand.request_id(), telecommand.source(), telecommand.ack()};
}

}  // namespace hirosco::pus
