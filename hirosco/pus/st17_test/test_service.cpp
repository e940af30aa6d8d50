// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st17_test/test_service.hpp"

#include <array>
#include <span>
#include <string_view>

#include "hirosco/pus/packet/cuc.hpp"
#include "hirosco/pus/st01_verification/instructions.hpp"

namespace hirosco::pus {
namespace st17 {
using enum TestService::Subtype;

constexpr std::array outcomes{to_text(SelfTestOutcome::NeverRun), to_text(SelfTestOutcome::Passed),
                              to_text(SelfTestOutcome::Failed), to_text(SelfTestOutcome::Running),
                              to_text(SelfTestOutcome::Void)};
constexpr std::uint16_t safe_operational = 1U << static_cast<unsigned>(descriptor::State::SafeOperational);

constexpr Part outcome[]{{.name = "OUTCOME", .type = Type::Uint8, .names = outcomes},
                         number("CONFIGURATION", Type::Uint8),
                         {.name = "TIME", .form = Form::Time},
                         number("CODE", Type::Uint16),
                         number("NUMBER", Type::Int64),
                         {.name = "REASON", .form = Form::Word}};
constexpr RequestKind requests[]{
    {.subtype = are_you_alive, .name = "PING", .data = {}, .words = "Are you alive? (service 17)"},
    {.subtype = run_self_test,
     .name = "SELF_TEST",
     .data = {},
     .words = "Runs the subsystem's self test; its actuators stay off (service 17)",
     .states = safe_operational,
     .needs = Needs::Nothing},
    {.subtype = report_self_test,
     .name = "REPORT_SELF_TEST",
     .data = {},
     .words = "Tells the outcome of the newest self test (service 17)",
     .needs = Needs::Nothing}};
constexpr ReportKind reports[]{{alive_report, "ALIVE", {}}, {self_test_report, "SELF_TEST_OUTCOME", outcome}};
}  // namespace st17

const ServiceKind TestService::service_kind{.type = service_type,
                                            .name = "test",
                                            .needs = Needs::Essential,
                                            .requests = st17::requests,
                                            .reports = st17::reports,
                                            .make = [](ServiceHome& home) -> std::unique_ptr<Service> {
                                              return std::make_unique<TestService>(home.verification(),
                                                                                   home.telemetry(), home.self_test());
                                            }};

Octets write_self_test(MutableOctets room, const SelfTestRecord& record) noexcept {
  const std::string_view words = record.reason.view();
  OctetWriter writer{room};
  writer.put(static_cast<std::uint8_t>(record.outcome)).put(record.configuration).put(Octets{to_cuc(record.at)});
  writer.put(static_cast<std::uint16_t>(record.code)).put(record.number).put(static_cast<std::uint8_t>(words.size()));
  writer.put(std::as_bytes(std::span{words}));
  return writer.written();
}

void TestService::handle(const TelecommandView& telecommand, const Request& request) {
  const std::uint8_t subtype = telecommand.subtype();
  if (service_kind.request(subtype) == nullptr) return verification_.rejected(request, unknown_subtype(telecommand));
  if (!telecommand.application_data().empty())
    return verification_.rejected(request, FailureNotice{FailureCode::DataLength});
  verification_.accepted(request);
  if (subtype == run_self_test) {
    if (const auto begun = self_test_.begin_self_test(request); !begun)
      verification_.start_failed(request, begun.error());
    return;
  }
  verification_.started(request);
  if (subtype == are_you_alive) sink_.report(service_type, alive_report, request.source, {});
  else {
    std::array<std::byte, max_self_test_octets> room;
    sink_.report(service_type, self_test_report, request.source, write_self_test(room, self_test_.newest_self_test()));
  }
  verification_.completed(request);
}

}  // namespace hirosco::pus
