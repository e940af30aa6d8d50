// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/standard_services.hpp"

#include <algorithm>
#include <array>

#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/pus/st130_descriptor/descriptor_service.hpp"
#include "hirosco/pus/st17_test/test_service.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"

namespace hirosco::pus {
namespace {

/// A service under its type, which stands in its kind as well but is not known there while this is compiled;
/// `standard_services_test.cpp` holds the two against each other.
struct OfType {
  std::uint8_t type;
  const ServiceKind* kind;
};

/// A further one: its recipe stands in the header. One of an author's own needs no row: `subsystem/author/custom_service.hpp`.
constexpr std::array rows{OfType{Verification::service_type, &Verification::service_kind},
                          OfType{HousekeepingService::service_type, &HousekeepingService::service_kind},
                          OfType{EventService::service_type, &EventService::service_kind},
                          OfType{FunctionService::service_type, &FunctionService::service_kind},
                          OfType{TestService::service_type, &TestService::service_kind},
                          OfType{ParameterService::service_type, &ParameterService::service_kind},
                          OfType{st128::service_type, &st128::service_kind},
                          OfType{st129::service_type, &st129::service_kind},
                          OfType{DescriptorService::service_type, &DescriptorService::service_kind}};

}  // namespace

std::span<const ServiceKind* const> standard_services() noexcept {
  static constexpr auto kinds = [] {
    std::array<const ServiceKind*, rows.size()> all{};
    std::ranges::transform(rows, all.begin(), &OfType::kind);
    return all;
  }();
  return kinds;
}

constexpr std::array<const ServiceKind*, 256> standard_services_by_type = [] {
  std::array<const ServiceKind*, 256> kinds{};
  for (const OfType& row : rows) kinds[row.type] = row.kind;
  return kinds;
}();

}  // namespace hirosco::pus
