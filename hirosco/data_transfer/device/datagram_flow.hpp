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
/// UNIX: `address` is a path of at most 90 characters; the subsystem is at "<path>.subsystem".
[[nodiscard]] Result<std::unique_ptr<DataFlow>> open_unix_flow(const std::string& address, FlowSide side);

/// Whom a socket sends to by UDP no rule narrows down: all in this computer that listens is reached.
void let_in_udp(const std::string& address, Sandbox& sandbox);
[[nodiscard]] bool is_reached_by_udp(const std::string& address, const Sandbox& sandbox);
inline constexpr FlowAccess udp_access{let_in_udp, is_reached_by_udp};
/// Whom a UNIX socket connects to neither, but it is made beside the device's.
void let_in_unix(const std::string& address, Sandbox& sandbox);
[[nodiscard]] bool is_reached_by_unix(const std::string& address, const Sandbox& sandbox);
inline constexpr FlowAccess unix_access{let_in_unix, is_reached_by_unix};

}  // namespace hirosco
