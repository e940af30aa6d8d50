// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st130_descriptor/descriptor_service.hpp"

#include <utility>

namespace hirosco::pus {
namespace st130 {
constexpr Part text[]{number("OCTETS", Type::Uint32)};
constexpr RequestKind requests[]{{DescriptorService::judge_text, "JUDGE_DESCRIPTOR", text},
                                 {DescriptorService::take_text, "TAKE_DESCRIPTOR", {}}};
}  // namespace st130

const ServiceKind DescriptorService::service_kind{.type = service_type,
                                                  .name = "descriptor",
                                                  .needs = Needs::SupervisorAsks,
                                                  .requests = st130::requests,
                                                  .reports = {}};

void DescriptorService::handle(const TelecommandView& telecommand, const Request& request) {
  const MemoryHandle memory = std::exchange(memory_, {});
  OctetReader reader{telecommand.application_data()};
  switch (telecommand.subtype()) {
    case judge_text: {
      const auto octets = reader.get<std::uint32_t>();
      if (!reader.exhausted()) return verification_.rejected(request, FailureNotice{FailureCode::DataLength});
      verification_.accepted(request);
      return answer(request, owner_.judge(octets, memory));
    }
    case take_text:
      if (!reader.exhausted()) return verification_.rejected(request, FailureNotice{FailureCode::DataLength});
      verification_.accepted(request);
      return answer(request, owner_.take());
    default:
      verification_.rejected(
          request, FailureNotice{FailureCode::UnknownSubtype}.with(telecommand.service()).with(telecommand.subtype()));
  }
}

void DescriptorService::answer(const Request& request, const std::optional<FailureNotice>& refused) {
  if (refused) return verification_.start_failed(request, *refused);
  verification_.started(request);
  verification_.completed(request);
}

}  // namespace hirosco::pus
