// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/refusals.hpp"

#include <fmt/format.h>

#include <string>

namespace hirosco::supervisor {
namespace {

using pus::FailureCode;
using pus::FailureNotice;

/// Reports on damaged packets in one second.
constexpr int damaged_reports_per_second = 10;

}  // namespace

void Refusals::refuse(Octets packet, const Origin& origin, const pus::Request& request, const FailureNotice& notice) {
  const bool damaged = notice.code() == FailureCode::ErrorControl || notice.code() == FailureCode::IllegalLength ||
                       notice.code() == FailureCode::IllegalPrimaryHeader ||
                       notice.code() == FailureCode::IllegalSequenceFlags;
  // Beyond the cap they are counted only: a flood of them must not fill the log's queue before honest telecommands.
  if (damaged && reports_in_window_ > damaged_reports_per_second) return traffic_.count_rejection(notice.code());
  const auto header = pus::read_primary_header(packet);
  std::string note{to_text(notice.code())};
  // Nobody else says which client of the ground link it was.
  if (notice.code() == FailureCode::ForeignSource && origin.is_ground())
    note += fmt::format(", client {}", origin.client());
  if (const auto reason = pus::reason_in(notice.data())) note += fmt::format(": {}", reason->text);
  static_cast<void>(craft_.log.append({.kind = LogKind::TelecommandRefused,
                                       .source = origin.apid(),
                                       .peer = header ? header->apid : std::uint16_t{0},
                                       .packet = packet,
                                       .note = std::string_view{note}}));
  if (notice.code() == FailureCode::UnknownApid) own_.verification().routing_failed(request, notice);
  else own_.verification().rejected(request, notice);
}

void Refusals::refuse_damaged(Octets packet, const Origin& origin, const FailureNotice& notice) {
  const auto header = pus::read_primary_header(packet);
  if (header && header->apid == pus::idle_apid) return;  // idle packets are dropped silently
  const std::uint32_t request_id = header ? header->request_id : 0;
  if (craft_.now - report_window_ >= 1s) {
    report_window_ = craft_.now;
    reports_in_window_ = 0;
  }
  ++reports_in_window_;
  refuse(packet, origin, {request_id, origin.apid(), 0}, notice);
}

}  // namespace hirosco::supervisor
