// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st129_supervision/supervision.hpp"

namespace hirosco::pus::st129 {
namespace kind {

constexpr Part packet[]{{.name = "TELECOMMAND", .form = Form::Rest}};
constexpr Part answer[]{number("REQUEST", Type::Uint32), number("PERMITTED", Type::Uint8),
                        number("CODE", Type::Uint16)};
constexpr RequestKind requests[]{{permission_question, "IS_IT_PERMITTED", packet}};
constexpr ReportKind reports[]{{permission_answer, "PERMISSION", answer}, {telecommand_copy, "COPY", packet}};

}  // namespace kind

const ServiceKind service_kind{.type = service_type,
                               .name = "supervision",
                               .needs = Needs::SupervisorAnswers,
                               .requests = kind::requests,
                               .reports = kind::reports};

}  // namespace hirosco::pus::st129
