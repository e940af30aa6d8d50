// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/service/service_kind.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// What every PUS service is given and is: protocol logic without I/O.
namespace hirosco {
class ParameterCell;
}

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

class Verification;
class SelfTest;

/// The application process that a service belongs to.
class ServiceHome {
 public:
  virtual ~ServiceHome() = default;
  [[nodiscard]] virtual const descriptor::SubsystemDescriptor& descriptor() const noexcept = 0;
  [[nodiscard]] virtual descriptor::State state() const noexcept = 0;
  /// Whether the mode that permitted the request under way is in force still: in a loop of its own another may have come.
  [[nodiscard]] virtual bool mode_in_force() const noexcept { return true; }
  [[nodiscard]] virtual Verification& verification() noexcept = 0;
  [[nodiscard]] virtual TelemetrySink& telemetry() noexcept = 0;
  [[nodiscard]] virtual SelfTest& self_test() noexcept = 0;
  /// The notice of an author's refusal.
  [[nodiscard]] virtual FailureNotice refusal(FailureCode code, const Error& why) const = 0;
  /// Sets a published parameter, packed and big-endian, at the next cycle boundary, whole. NotFound: it is not published;
  /// ResourceExhausted: too many are waiting; OutOfRange, InvalidArgument: of the octets.
  [[nodiscard]] virtual Result<> store(const ParameterCell&, Octets) {
    return fail(ErrorCode::Unavailable, "no parameters here");
  }
  /// Reports an event of the descriptor.
  [[nodiscard]] virtual Result<> raise(std::string_view, Octets) {
    return fail(ErrorCode::Unavailable, "no events here");
  }
  /// Whether a report of so many octets finds room; what verifies a request always does.
  [[nodiscard]] virtual bool has_room(std::size_t) const noexcept { return true; }
};

/// A PUS service of one application process. handle() is called with telecommands of its type only; it does the
/// acceptance checks from the subtype on (9 to 11) and reports every stage through the Verification it was made with.
/// Thread: the service loop, or the loop of its own that the descriptor gives it (docs/adr/0096).
class Service {
 public:
  virtual ~Service() = default;
  /// What it takes and reports.
  [[nodiscard]] virtual const ServiceKind& kind() const noexcept = 0;
  [[nodiscard]] std::uint8_t type() const noexcept { return kind().type; }
  virtual void handle(const TelecommandView& telecommand, const Request& request) = 0;
  /// False while the service has nothing to work with: its telecommands are refused as of the wrong state.
  [[nodiscard]] virtual bool in_force() const noexcept { return true; }
  /// A configuration is put in force; what fails here fails its CONFIGURE.
  [[nodiscard]] virtual Result<> configure(const descriptor::Configuration&) { return ok(); }
  /// None is in force any more, and no cycle uses what the service has given to it.
  virtual void release() noexcept {}
  /// Each step of its loop.
  virtual void step(TimePoint) {}
  /// Memory that came beside the telecommand which is handled next.
  virtual void accompany(const MemoryHandle&) {}
};

[[nodiscard]] inline Request request_of(const TelecommandView& telecommand) noexcept {
  return {telecommand.request_id(), telecommand.source(), telecommand.ack()};
}

}  // namespace hirosco::pus
