// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/requests.hpp"

#include "hirosco/pus/st17_test/test_service.hpp"
#include "hirosco/pus/standard_services.hpp"

namespace hirosco::pus {

using descriptor::Function;

std::vector<Function> requests_of(const descriptor::Subsystem& subsystem) {
  std::vector<Function> requests = common_functions();
  for (const ServiceKind* service : standard_services())
    for (const RequestKind& kind : service->requests) {
      if (kind.words.empty()) continue;
      Function request;
      request.name = kind.name;
      request.service = service->type;
      request.subtype = kind.subtype;
      request.states = kind.states;
      request.essential = service->needs_of(kind.subtype) == Needs::Essential;
      request.description = kind.words;
      requests.push_back(std::move(request));
    }
  requests.insert(requests.end(), subsystem.functions.begin(), subsystem.functions.end());
  for (const auto& service : subsystem.services)
    requests.insert(requests.end(), service.requests.begin(), service.requests.end());
  return requests;
}

bool goes_alone(const Function& request) noexcept {
  return request.essential && request.service != TestService::service_type;
}

Result<std::vector<std::byte>> encode_request(const Function& request, GivenValues values) {
  if (request.service == FunctionService::service_type) return encode_call(request, values);
  std::vector<std::byte> data;
  HIROSCO_TRY(append_values(data, request.arguments, values, Ids::None));
  return data;
}

std::optional<std::vector<Value>> decode_request(const Function& request, Octets data) {
  if (request.service == FunctionService::service_type) {
    const auto call = decode_call({&request, 1}, data);
    if (!call) return std::nullopt;
    return ArgumentReader{request.arguments, call->arguments}.rest();
  }
  if (!first_not_permitted(request.arguments, data)) return std::nullopt;
  return ArgumentReader{request.arguments, data}.rest();
}

}  // namespace hirosco::pus
