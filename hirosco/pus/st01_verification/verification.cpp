// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "hirosco/pus/st01_verification/verification.hpp"

namespace hirosco::pus {
namespace {
constexpr std::size_t max_report_octets = 4 + 2 + 2 + FailureNotice::max_data_octets;
}  // namespace

namespace st01 {
constexpr Part success[]{number("REQUEST", Type::Uint32)};
constexpr Part step[]{number("REQUEST", Type::Uint32), number("STEP", Type::Uint16)};
constexpr Part failure[]{
    number("REQUEST", Type::Uint32), number("CODE", Type::Uint16), {.name = "DATA", .form = Form::Rest}};
constexpr Part failed_step[]{number("REQUEST", Type::Uint32),
                             number("STEP", Type::Uint16),
                             number("CODE", Type::Uint16),
                             {.name = "DATA", .form = Form::Rest}};
constexpr ReportKind reports[]{{1, "accepted", success},   {2, "not accepted", failure},
                               {3, "started", success},    {4, "start failed", failure},
                               {5, "progress", step},      {6, "progress failed", failed_step},
                               {7, "completed", success},  {8, "completion failed", failure},
                               {10, "not routed", failure}};
}  // namespace st01

const ServiceKind Verification::service_kind{
    .type = service_type, .name = "verification", .requests = {}, .reports = st01::reports};

void Verification::accepted(const Request& request) {
  if ((request.ack & ack_acceptance) != 0) send(1, request, nullptr, nullptr);
}
void Verification::rejected(const Request& request, const FailureNotice& notice) { send(2, request, nullptr, &notice); }
void Verification::started(const Request& request) {
  if ((request.ack & ack_start) != 0) send(3, request, nullptr, nullptr);
}
void Verification::start_failed(const Request& request, const FailureNotice& notice) {
  send(4, request, nullptr, &notice);
}
void Verification::progressed(const Request& request, std::uint16_t step) {
  if ((request.ack & ack_progress) != 0) send(5, request, &step, nullptr);
}
void Verification::progress_failed(const Request& request, std::uint16_t step, const FailureNotice& notice) {
  send(6, request, &step, &notice);
}
void Verification::completed(const Request& request) {
  if ((request.ack & ack_completion) != 0) send(7, request, nullptr, nullptr);
}
void Verification::completion_failed(const Request& request, const FailureNotice& notice) {
  send(8, request, nullptr, &notice);
}
void Verification::routing_failed(const Request& request, const FailureNotice& notice) {
  send(10, request, nullptr, &notice);
}

void Verification::send(std::uint8_t subtype, const Request& request, const std::uint16_t* step,
                        const FailureNotice* notice) {
  std::array<std::byte, max_report_octets> buffer;
  OctetWriter writer{buffer};
  writer.put(request.id);
  if (step != nullptr) writer.put(*step);
  if (notice != nullptr) writer.put(static_cast<std::uint16_t>(notice->code())).put(notice->data());
  sink_.report(service_type, subtype, request.source, writer.written());
}

}  // namespace hirosco::pus
