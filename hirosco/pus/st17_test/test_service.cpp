// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st17_test/test_service.hpp"

#include "hirosco/pus/st01_verification/instructions.hpp"

namespace hirosco::pus {
namespace st17 {
using enum TestService::Subtype;
constexpr RequestKind requests[]{{are_you_alive, "PING", {}}};
constexpr ReportKind reports[]{{alive_report, "ALIVE", {}}};
}  // namespace st17

const ServiceKind TestService::service_kind{.type = service_type,
                                            .name = "test",
                                            .needs = Needs::Essential,
                                            .requests = st17::requests,
                                            .reports = st17::reports,
                                            .make = [](ServiceHome& home) -> std::unique_ptr<Service> {
                                              return std::make_unique<TestService>(home.verification(),
                                                                                   home.telemetry());
                                            }};

void TestService::handle(const TelecommandView& telecommand, const Request& request) {
  if (telecommand.subtype() != are_you_alive) return verification_.rejected(request, unknown_subtype(telecommand));
  if (!telecommand.application_data().empty())
    return verification_.rejected(request, FailureNotice{FailureCode::DataLength});
  verification_.accepted(request);
  verification_.started(request);
  sink_.report(service_type, alive_report, request.source, {});
  verification_.completed(request);
}

}  // namespace hirosco::pus
