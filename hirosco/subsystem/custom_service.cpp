// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/custom_service.hpp"

#include <algorithm>
#include <array>

#include "hirosco/pus/st01_verification/instructions.hpp"

namespace hirosco {
namespace {

/// Requests of one service that run at once: an author who never ends them is asked for no more.
constexpr std::size_t most_running = 64;

using pus::FailureCode;
using pus::FailureNotice;

/// Whether a C++ layout has these fields, in order.
[[nodiscard]] bool same(std::span<const NativeField> native, std::span<const descriptor::Field> declared) {
  return std::ranges::equal(native, declared, [](const NativeField& n, const descriptor::Field& d) {
    return n.type == d.type && n.count == d.count;
  });
}

[[nodiscard]] std::vector<descriptor::Field> fields_of(const descriptor::Function& request) {
  std::vector<descriptor::Field> fields;
  for (const auto& argument : request.arguments) fields.push_back(argument.field);
  return fields;
}

[[nodiscard]] std::size_t octets_of(std::span<const descriptor::Field> fields) {
  std::size_t octets = 0;
  for (const auto& field : fields) octets += field.octets();
  return octets;
}

[[nodiscard]] std::string text_of(std::span<const descriptor::Field> fields) {
  std::string text;
  for (const auto& field : fields)
    text.append(text.empty() ? "" : ", ").append(descriptor_text(field.type, field.count));
  return text.empty() ? "nothing" : text;
}
[[nodiscard]] std::string text_of(std::span<const NativeField> fields) {
  std::string text;
  for (const auto& field : fields) text.append(text.empty() ? "" : ", ").append(cpp_text(field));
  return text.empty() ? "nothing" : text;
}

/// One number between the wire and memory: the octets in the other order where the machine's is little.
void copy_number(Octets from, MutableOctets to) noexcept {
  if constexpr (std::endian::native == std::endian::big) std::ranges::copy(from, to.begin());
  else std::ranges::reverse_copy(from, to.begin());
}

/// The first argument whose value the descriptor does not permit, from 1.
[[nodiscard]] std::optional<std::size_t> bad_argument(const descriptor::Function& declared, Octets data) {
  OctetReader reader{data};
  for (std::size_t i = 0; i < declared.arguments.size(); ++i)
    for (std::uint16_t element = 0; element < declared.arguments[i].field.count; ++element)
      if (!pus::permits(declared.arguments[i], read_number(reader, declared.arguments[i].field.type))) return i + 1;
  return std::nullopt;
}

[[nodiscard]] bool same_request(const pus::Request& one, const pus::Request& other) {
  return one.id == other.id && one.source == other.source;
}

}  // namespace

void CustomService::bind(std::string_view request, std::span<const NativeField> arguments, Handler handler) {
  std::erase_if(bound_, [&](const Bound& bound) { return bound.request == request; });
  bound_.push_back({std::string{request}, arguments, std::move(handler)});
}

void CustomService::join(pus::ServiceHome& home) {
  home_ = &home;
  open_.clear();
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
    if (const auto fields = fields_of(*request); !same(bound.arguments, fields))
      problems.push_back("on_request " + bound.request + ": the handler takes " + text_of(bound.arguments) +
                         ", the descriptor declares " + text_of(fields));
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
  const auto fields = fields_of(*declared);
  if (data.size() != octets_of(fields)) return verification.rejected(request, FailureNotice{FailureCode::DataLength});
  if (!declared->permitted_in(home_->state()))
    return verification.rejected(
        request, FailureNotice{FailureCode::WrongState}.with(static_cast<std::uint8_t>(home_->state())));
  if (open_.size() >= most_running) return verification.rejected(request, FailureNotice{FailureCode::QueueFull});
  verification.accepted(request);
  if (const auto bad = bad_argument(*declared, data))
    return verification.start_failed(
        request,
        FailureNotice{FailureCode::ValueNotAcceptable}.with(std::uint8_t{0}).with(static_cast<std::uint32_t>(*bad)));
  // Open before it runs: whoever finishes at once is heard, too.
  open_.push_back(request);
  const Outcome outcome = bound->handler(data, {request});
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
  for (const pus::Request& request : std::exchange(open_, {}))
    home_->verification().completion_failed(request, FailureNotice{FailureCode::Aborted});
}

void CustomService::from_wire(std::span<const NativeField> fields, Octets data, MutableOctets native) noexcept {
  for (const NativeField& field : fields) {
    const std::size_t each = hirosco::octets_of(field.type);
    for (std::uint16_t i = 0; i < field.count; ++i, data = data.subspan(each))
      copy_number(data.first(each), native.subspan(field.offset + i * each, each));
  }
}

Result<> CustomService::send(std::string_view report, const Call& to, std::span<const NativeField> fields,
                             Octets native) {
  if (home_ == nullptr || declared_ == nullptr) return fail(ErrorCode::Unavailable, "the service is not provided");
  const auto declared = std::ranges::find(declared_->reports, report, &descriptor::CustomService::Report::name);
  if (declared == declared_->reports.end()) return fail(ErrorCode::NotFound, "the descriptor declares no such report");
  if (!same(fields, declared->fields)) return fail(ErrorCode::Mismatch, "the descriptor's report has other fields");
  std::vector<std::byte> data(octets_of(declared->fields));
  MutableOctets rest{data};
  for (const NativeField& field : fields) {
    const std::size_t each = hirosco::octets_of(field.type);
    for (std::uint16_t i = 0; i < field.count; ++i, rest = rest.subspan(each))
      copy_number(native.subspan(field.offset + i * each, each), rest.first(each));
  }
  home_->telemetry().report(declared_->type, declared->subtype, to.request.source, data);
  return ok();
}

}  // namespace hirosco
