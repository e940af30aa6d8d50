// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/data_transfer/device/flow_means.hpp"

namespace hirosco {

/// Device frames as datagrams, in order, one system call each. The device has the address; it answers whoever sent to it
/// last. Frames that nobody fetches stay in the system's buffer up to its limit.
/// UDP: `address` is "host:port" of this computer, or of a permitted network; NotPermitted for any other (decision 2).
[[nodiscard]] Result<std::unique_ptr<DataFlow>> open_udp_flow(const FlowOpening& opening);
/// UNIX: `address` is a path of at most 90 characters; the subsystem is at "<path>.subsystem". Where there is a folder of
/// a subsystem that is a user of its own (private_folder.hpp) both are in it: "<path>/socket", "<path>/socket.subsystem".
[[nodiscard]] Result<std::unique_ptr<DataFlow>> open_unix_flow(const std::string& address, FlowSide side);

/// Whom a socket sends to by UDP no rule narrows down: all in this computer that listens is reached.
void let_in_udp(const std::string& address, Sandbox& sandbox);
[[nodiscard]] bool is_reached_by_udp(const std::string& address, const Sandbox& sandbox);
inline constexpr FlowAccess udp_access{
    .let_in = let_in_udp, .is_reached = is_reached_by_udp, .own = &own_as_of_one_user};
/// Whom a UNIX socket connects to neither, but it is made beside the device's.
void let_in_unix(const std::string& address, Sandbox& sandbox);
[[nodiscard]] bool is_reached_by_unix(const std::string& address, const Sandbox& sandbox);
/// Of a user of its own: the folder of this address, which both sockets are in.
[[nodiscard]] std::string own_unix_folder(const std::string& address);
[[nodiscard]] Result<> make_own_unix_folder(const std::string& address, const OwnGroup& own);
void let_in_own_unix(const std::string& address, Sandbox& sandbox);
void forget_own_unix(const std::string& folder);
inline constexpr OwnFlowAccess own_unix_access{.folder = own_unix_folder,
                                               .make_folder = make_own_unix_folder,
                                               .let_in = let_in_own_unix,
                                               .forget = forget_own_unix,
                                               .on_disk = true};
inline constexpr FlowAccess unix_access{
    .let_in = let_in_unix, .is_reached = is_reached_by_unix, .own = &own_unix_access};

}  // namespace hirosco
