// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/flow_means.hpp"

#include <array>

#include "hirosco/data_transfer/device/datagram_flow.hpp"
#include "hirosco/data_transfer/device/shared_memory_flow.hpp"

namespace hirosco {
namespace {

/// A means is in force where it stands here: for descriptors, subsystems, the supervisor's inhibits and devices.
constexpr std::array built_in_means{
    FlowMeans{Transfer::SharedMemory, AddressForm::Name, SharedMemoryFlow::open},
    FlowMeans{Transfer::Unix, AddressForm::Name, open_unix_flow},
    FlowMeans{Transfer::Udp, AddressForm::HostPort, open_udp_flow},
};

}  // namespace

std::span<const FlowMeans> standard_flow_means() noexcept { return built_in_means; }

}  // namespace hirosco
