// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "hirosco/data_transfer/device/datagram_flow.hpp"
#include "hirosco/data_transfer/device/flow_means.hpp"

namespace hirosco {
namespace {

/// With POSIX alone a device is reached by datagrams: its shared memory needs locks of an open file and a futex, which are Linux's.
constexpr std::array built_in_means{
    FlowMeans{Transfer::Unix, AddressForm::Name,
              [](const FlowOpening& at) { return open_unix_flow(at.address, at.side); }, unix_access},
    FlowMeans{Transfer::Udp, AddressForm::HostPort, open_udp_flow, udp_access},
};

}  // namespace

std::span<const FlowMeans> standard_flow_means() noexcept { return built_in_means; }

}  // namespace hirosco
