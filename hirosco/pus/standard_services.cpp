// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/standard_services.hpp"

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

/// A further one: its recipe stands in the header. One of an author's own needs no row: `subsystem/author/custom_service.hpp`.
std::span<const ServiceKind* const> standard_services() noexcept {
  static constexpr std::array services{&Verification::service_kind,
                                       &HousekeepingService::service_kind,
                                       &EventService::service_kind,
                                       &FunctionService::service_kind,
                                       &TestService::service_kind,
                                       &ParameterService::service_kind,
                                       &st128::service_kind,
                                       &st129::service_kind,
                                       &DescriptorService::service_kind};
  return services;
}

/// Asked of every packet on each hop.
const ServiceKind* standard_service(std::uint8_t type) noexcept {
  static const auto by_type = [] {
    std::array<const ServiceKind*, 256> kinds{};
    for (const ServiceKind* kind : standard_services()) kinds[kind->type] = kind;
    return kinds;
  }();
  return by_type[type];
}

}  // namespace hirosco::pus
