// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/flow_means.hpp"

namespace hirosco {

/// Device frames as datagrams, in order, one system call each. The device has the address; it answers whoever sent to it
/// last. Frames that nobody fetches stay in the system's buffer up to its limit.
/// UDP: `address` is "host:port" of this computer, or of a permitted network; NotPermitted for any other (decision 2).
[[nodiscard]] Result<std::unique_ptr<DataFlow>> open_udp_flow(const FlowOpening& opening);
/// UNIX: `address` is a path of at most 90 characters; the subsystem is at "<path>.subsystem".
[[nodiscard]] Result<std::unique_ptr<DataFlow>> open_unix_flow(const std::string& address, FlowSide side);

}  // namespace hirosco
