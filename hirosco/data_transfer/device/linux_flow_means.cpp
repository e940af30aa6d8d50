// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/flow_means.hpp"

#include <array>

#include "hirosco/data_transfer/device/datagram_flow.hpp"
#include "hirosco/data_transfer/device/message_queue_flow.hpp"
#include "hirosco/data_transfer/device/serial_flow.hpp"
#include "hirosco/data_transfer/device/shared_memory_flow.hpp"
#include "hirosco/data_transfer/device/tcp_flow.hpp"

namespace hirosco {
namespace {

/// A means is in force where it stands here: for descriptors, subsystems, the supervisor's inhibits and devices.
constexpr std::array built_in_means{
    FlowMeans{Transfer::SharedMemory, AddressForm::Name,
              [](const FlowOpening& at) { return SharedMemoryFlow::open(at.address, at.side, at.holder); },
              shared_memory_access},
    FlowMeans{Transfer::Unix, AddressForm::Name,
              [](const FlowOpening& at) { return open_unix_flow(at.address, at.side); }, unix_access},
    FlowMeans{Transfer::Udp, AddressForm::HostPort, open_udp_flow, udp_access},
    FlowMeans{Transfer::Tcp, AddressForm::HostPort, open_tcp_flow, tcp_access},
    FlowMeans{Transfer::Serial, AddressForm::Line, open_serial_flow, serial_access},
    FlowMeans{Transfer::MessageQueue, AddressForm::Name,
              [](const FlowOpening& at) { return open_message_queue_flow(at.address, at.side); }, message_queue_access},
};

}  // namespace

std::span<const FlowMeans> standard_flow_means() noexcept { return built_in_means; }

}  // namespace hirosco
