// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/device_socket.hpp"

#include <cerrno>
#include <optional>

namespace hirosco {
namespace {

[[nodiscard]] bool set_option(const FileDescriptor& socket, int option, int value) noexcept {
  return ::setsockopt(socket.get(), SOL_SOCKET, option, &value, sizeof value) == 0;
}

/// From where the system would speak to the device without a gateway; that has to be in its network, too.
[[nodiscard]] Result<SocketAddress> own_address(const DeviceRoute& route) {
  HIROSCO_TRY_LET(const FileDescriptor probe, make_device_socket(SOCK_DGRAM, route, {}));
  std::optional<InternetAddress> own;
  if (::connect(probe.get(), route.device.get(), route.device.octets) != 0 ||
      !(own = own_internet_address(probe.get())))
    return fail(ErrorCode::Unavailable, "there is no way to the device's network", errno);
  if (!route.network->contains(*own))
    return fail(ErrorCode::Unavailable, "this computer has no address in the device's network");
  own->port = 0;
  return socket_address(*own);
}

}  // namespace

Result<DeviceRoute> find_route(const FlowOpening& opening) {
  HIROSCO_TRY_LET(const InternetAddress address, read_device_address(opening.address));
  DeviceRoute route{.device = socket_address(address), .own = {}, .network = nullptr};
  if (address.loopback()) return route;
  route.network = find_network(opening.networks, address);
  if (route.network == nullptr)
    return fail(ErrorCode::NotPermitted, "address is neither a loopback one nor in a device network of the mission");
  if (opening.side == FlowSide::Device) return route;
  HIROSCO_TRY_LET(route.own, own_address(route));
  return route;
}

Result<FileDescriptor> make_device_socket(int type, const DeviceRoute& route, const SocketAddress& bound_to) noexcept {
  FileDescriptor socket{::socket(route.device.storage.ss_family, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!socket) return fail(ErrorCode::SystemFailure, "make socket", errno);
  if (route.network != nullptr) {
    if (!set_option(socket, SO_DONTROUTE, 1))
      return fail(ErrorCode::SystemFailure, "keep a socket in its network", errno);
    const std::string& interface = route.network->interface;
#ifdef SO_BINDTODEVICE
    if (!interface.empty() && ::setsockopt(socket.get(), SOL_SOCKET, SO_BINDTODEVICE, interface.c_str(),
                                           static_cast<socklen_t>(interface.size() + 1)) != 0)
      return fail(ErrorCode::Unavailable, "keep a socket at its interface", errno);
#endif
  }
  if (bound_to.octets == 0) return socket;
  // A listener that ended a moment ago is no other listener.
  if (type == SOCK_STREAM && !set_option(socket, SO_REUSEADDR, 1))
    return fail(ErrorCode::SystemFailure, "option of a socket", errno);
  if (::bind(socket.get(), bound_to.get(), bound_to.octets) == 0) return socket;
  return errno == EADDRINUSE ? fail(ErrorCode::AlreadyExists, "this side of the flow is open", errno)
                             : fail(ErrorCode::SystemFailure, "bind socket", errno);
}

}  // namespace hirosco
