// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/data_transfer/address/socket_address.hpp"
#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

/// What UDP and TCP have in common: where a device is, and that nothing goes beyond the network that the mission permits.
namespace hirosco {

/// Where a device is, and for whoever speaks to it from outside of this computer, from where.
struct DeviceRoute {
  SocketAddress device;
  SocketAddress own;  ///< of the subsystem, port 0; octets 0: in this computer, wherever the system puts it
  const DeviceNetwork* network{nullptr};  ///< null: it is in this computer
};
/// NotPermitted: an address outside this computer in no permitted network. Unavailable: nothing of this computer is in that network.
/// InvalidArgument: no address. `opening` must outlive it.  Realtime: blocks, allocates.
[[nodiscard]] Result<DeviceRoute> find_route(const FlowOpening& opening);

/// A socket that does not block, of SOCK_DGRAM or SOCK_STREAM, from which nothing goes by a gateway or another interface where the
/// device is outside. Bound to `bound_to` unless that is empty. AlreadyExists: somebody is bound there.
/// Realtime: bounded, so many system calls.
[[nodiscard]] Result<FileDescriptor> make_device_socket(int type, const DeviceRoute& route,
                                                        const SocketAddress& bound_to) noexcept;

}  // namespace hirosco
