// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/custom_service.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "hirosco/pus/st01_verification/instructions.hpp"

namespace hirosco {
namespace {

/// Requests of one service that run at once: an author who never ends them is asked for no more.
constexpr std::size_t most_running = 64;

using pus::FailureCode;
using pus::FailureNotice;

[[nodiscard]] bool same_request(const pus::Request& one, const pus::Request& other) {
  return one.id == other.id && one.source == other.source;
}

}  // namespace

void CustomService::bind(std::string_view request, BoundHandler handler) {
  std::erase_if(bound_, [&](const Bound& bound) { return bound.request == request; });
  bound_.push_back({std::string{request}, std::move(handler)});
}

void CustomService::join(pus::ServiceHome& home) {
  home_ = &home;
  open_.clear();
  open_.reserve(most_running);
  declared_ = home.descriptor().find_service(name_);
  kind_ = {.type = declared_ != nullptr ? declared_->type : std::uint8_t{0},
           .name = name_,
           .requests = {},
           .reports = {},
           .make = nullptr};
}

std::vector<std::string> CustomService::problems() const {
  if (declared_ == nullptr) return {"provide: the descriptor declares no service '" + name_ + "'"};
  std::vector<std::string> problems;
  for (const Bound& bound : bound_) {
    const auto request = std::ranges::find(declared_->requests, bound.request, &descriptor::Function::name);
    if (request == declared_->requests.end()) {
      problems.push_back("on_request: service '" + name_ + "' declares no request '" + bound.request + "'");
      continue;
    }
    std::ranges::move(handler_mistakes("on_request " + bound.request + ": ", bound.handler.takes, request->arguments),
                      std::back_inserter(problems));
  }
  for (const auto& request : declared_->requests)
    if (std::ranges::find(bound_, request.name, &Bound::request) == bound_.end())
      problems.push_back("request declared but without a handler: " + request.name);
  return problems;
}

void CustomService::handle(const pus::TelecommandView& telecommand, const pus::Request& request) {
  auto& verification = home_->verification();
  const auto* declared = home_->descriptor().find_request(telecommand.service(), telecommand.subtype());
  const auto bound = declared == nullptr ? bound_.end() : std::ranges::find(bound_, declared->name, &Bound::request);
  if (bound == bound_.end()) return verification.rejected(request, pus::unknown_subtype(telecommand));
  const Octets data = telecommand.application_data();
  const auto not_permitted = pus::first_not_permitted(declared->arguments, data);
  if (!not_permitted) return verification.rejected(request, FailureNotice{FailureCode::DataLength});
  if (!declared->permitted_in(home_->state()))
    return verification.rejected(
        request, FailureNotice{FailureCode::WrongState}.with(static_cast<std::uint8_t>(home_->state())));
  if (open_.size() >= most_running) return verification.rejected(request, FailureNotice{FailureCode::QueueFull});
  verification.accepted(request);
  if (*not_permitted != 0)
    return verification.start_failed(request, FailureNotice{FailureCode::ValueNotAcceptable}
                                                  .with(std::uint8_t{0})
                                                  .with(static_cast<std::uint32_t>(*not_permitted)));
  // Open before it runs: whoever finishes at once is heard, too.
  open_.push_back(request);
  pus::ArgumentReader arguments{declared->arguments, data};
  const Outcome outcome = bound->handler.call(arguments, {request});
  if (outcome.kind == Outcome::Kind::Running) {
    if (is_open({request})) verification.started(request);
    return;
  }
  if (!close({request})) return;
  if (outcome.kind == Outcome::Kind::Refused)
    return verification.start_failed(request, home_->refusal(outcome.code, outcome.reason));
  verification.started(request);
  verification.completed(request);
}

bool CustomService::is_open(const Call& call) const {
  return std::ranges::any_of(open_, [&](const pus::Request& open) { return same_request(open, call.request); });
}

bool CustomService::close(const Call& call) {
  return std::erase_if(open_, [&](const pus::Request& open) { return same_request(open, call.request); }) != 0;
}

void CustomService::finish(const Call& call) {
  if (close(call)) home_->verification().completed(call.request);
}

void CustomService::abort(const Call& call, const Error& why) {
  if (!close(call)) return;
  const Outcome outcome{Result<>{std::unexpected{why}}};
  home_->verification().completion_failed(call.request, home_->refusal(outcome.code, why));
}

void CustomService::release() noexcept {
  for (const pus::Request& request : open_)
    home_->verification().completion_failed(request, FailureNotice{FailureCode::Aborted});
  open_.clear();  // its room stays: the next configuration has it
}

Result<> CustomService::send_value(const ParameterCell& parameter, Octets big_endian) {
  if (home_ == nullptr) return fail(ErrorCode::Unavailable, "the service is not provided");
  return home_->store(parameter, big_endian);
}

Result<> CustomService::send_event(std::string_view event, Octets auxiliary) {
  if (home_ == nullptr) return fail(ErrorCode::Unavailable, "the service is not provided");
  return home_->raise(event, auxiliary);
}

Result<> CustomService::send(std::string_view report, const Call& to, std::span<const NativeField> types,
                             pus::GivenValues values) {
  if (home_ == nullptr || declared_ == nullptr) return fail(ErrorCode::Unavailable, "the service is not provided");
  const auto declared = std::ranges::find(declared_->reports, report, &descriptor::CustomService::Report::name);
  if (declared == declared_->reports.end()) return fail(ErrorCode::NotFound, "the descriptor declares no such report");
  if (!same_types(types, declared->fields))
    return fail(ErrorCode::Mismatch, "the descriptor's report has other fields");
  std::array<std::byte, pus::max_telemetry_octets> room;
  OctetWriter writer{room};
  HIROSCO_TRY(pus::write_report(writer, declared->fields, values));
  HIROSCO_TRY_LET(const Octets data, pus::all_written(writer));
  if (!home_->has_room(data.size())) return fail(ErrorCode::ResourceExhausted, "the service loop is behind");
  home_->telemetry().report(declared_->type, declared->subtype, to.request.source, data);
  return ok();
}

}  // namespace hirosco
