// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/supervision_service.hpp"

#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"

namespace hirosco::supervisor {

const pus::ServiceKind& SupervisionService::kind() const noexcept { return pus::st129::service_kind; }

void SupervisionService::handle(const pus::TelecommandView& telecommand, const pus::Request& request) {
  const auto found = answers_.find(telecommand.subtype());
  if (found == answers_.end())
    return own_.verification().rejected(request, pus::FailureNotice{pus::FailureCode::UnknownSubtype});
  found->second(request, telecommand.application_data());
}

}  // namespace hirosco::supervisor
