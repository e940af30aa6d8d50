// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "hirosco/pus/service.hpp"

namespace hirosco::pus {
namespace {
constexpr std::uint8_t verification_service = 1;
constexpr std::size_t max_report_octets = 4 + 2 + 2 + FailureNotice::max_data_octets;
}  // namespace

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
  sink_.report(verification_service, subtype, request.source, writer.written());
}

}  // namespace hirosco::pus
