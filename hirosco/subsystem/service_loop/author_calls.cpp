// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/subsystem.hpp"

#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

/// What an author calls of `author/subsystem.hpp`: each goes to the part of the service loop or of the cycle that it is for.
namespace hirosco {
namespace {

[[nodiscard]] pus::FailureCode failure_code(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::InvalidArgument:
    case ErrorCode::OutOfRange: return pus::FailureCode::ValueNotAcceptable;
    case ErrorCode::NotFound: return pus::FailureCode::UnknownIdentifier;
    case ErrorCode::AlreadyExists: return pus::FailureCode::IdentifierExists;
    case ErrorCode::NotPermitted: return pus::FailureCode::NotPermittedNow;
    case ErrorCode::Unavailable: return pus::FailureCode::DeviceError;
    case ErrorCode::ResourceExhausted: return pus::FailureCode::CapacityExceeded;
    case ErrorCode::Timeout: return pus::FailureCode::Timeout;
    default: return pus::FailureCode::ExecutionError;
  }
}

}  // namespace

Outcome::Outcome(const Result<>& result) noexcept
    : kind{result ? Kind::Done : Kind::Refused},
      code{result ? pus::FailureCode{} : failure_code(result.error().code)},
      reason{result ? Error{} : result.error()} {}

void Subsystem::provide(CustomService& service) { framework_->introduction().provide(service); }
void Subsystem::publish(std::string_view name, ParameterCell& parameter) {
  framework_->introduction().publish(name, parameter);
}
void Subsystem::require_link(std::string_view set, LinkInputPort& port) {
  framework_->introduction().require_link(set, port);
}
void Subsystem::lend_link(std::string_view set, LoanOutputPort& port) {
  framework_->introduction().lend_link(set, port);
}
void Subsystem::use_event(EventPort& event) { framework_->introduction().use_event(event); }
void Subsystem::use_request(RequestPort& request, RequestHandler handler, Duration patience) {
  framework_->introduction().use_request(request, std::move(handler), patience);
}
void Subsystem::use_device(std::string_view name, DevicePortBase& port,
                           std::initializer_list<std::string_view> settings) {
  framework_->introduction().use_device(name, port, settings);
}
void Subsystem::bind_function(std::string_view name, BoundHandler handler) {
  framework_->introduction().bind_function(name, std::move(handler));
}

void Subsystem::raise_encoded(std::uint16_t event, Octets auxiliary) noexcept {
  framework_->cycle().reports().raise_encoded(event, auxiliary);
}
void Subsystem::raise_encoded_in_service(const EventPort& event, Octets auxiliary) {
  framework_->reports().raise_named(event.name(), auxiliary);
}
void Subsystem::inhibit_actuators() noexcept { framework_->cycle().inhibit(inhibited_by_author); }

void Subsystem::progress(const Call& call, std::uint16_t step) noexcept {
  framework_->cycle().reports().report(ReportKind::Progressed, step, call.request);
}
void Subsystem::progress_failed(const Call& call, std::uint16_t step, const Error& why) noexcept {
  fail_step(call, step, failure_code(why.code), why);
}
void Subsystem::fail_step(const Call& call, std::uint16_t step, pus::FailureCode code, const Error& why) noexcept {
  framework_->cycle().reports().fail_step(step, code, call.request, why);
}
void Subsystem::finish(const Call& call) noexcept {
  framework_->cycle().reports().report(ReportKind::Finished, 0, call.request);
}
void Subsystem::abort(const Call& call, const Error& why) noexcept { abort_call(call, failure_code(why.code), why); }
void Subsystem::abort_call(const Call& call, pus::FailureCode code, const Error& why) noexcept {
  framework_->cycle().reports().fail_call(ReportKind::Aborted, code, call.request, why);
}

Result<std::uint32_t> Subsystem::send_request(const RequestPort& asked, pus::GivenValues values) {
  return framework_->send_request(asked, values);
}
Result<Quota::Held> Subsystem::acquire_port() noexcept { return framework_->meter().ports().take(); }
Result<Quota::Held> Subsystem::acquire_file() noexcept { return framework_->meter().files().take(); }

void Subsystem::bind_subscription(SubscriptionPort& heard) { framework_->introduction().use_subscription(heard); }
Result<> Subsystem::set_subscription(SubscriptionPort& heard, bool wanted) {
  return framework_->subscriber().set(heard, wanted);
}
std::uint32_t Subsystem::newest_stop() const noexcept { return framework_->newest_stop(); }

Result<> Subsystem::submit_ground_telecommand(std::uint16_t client, Octets packet, std::uint32_t known_stop) {
  return framework_->submit_ground_telecommand(client, packet, known_stop);
}
PoolResource& Subsystem::resources() noexcept { return framework_->meter().pools(); }
State Subsystem::state() const noexcept { return framework_->state(); }
const descriptor::SubsystemDescriptor& Subsystem::own_descriptor() const noexcept { return framework_->descriptor(); }

}  // namespace hirosco
