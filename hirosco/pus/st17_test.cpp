// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st17_test.hpp"

#include "hirosco/pus/instructions.hpp"

namespace hirosco::pus {

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
