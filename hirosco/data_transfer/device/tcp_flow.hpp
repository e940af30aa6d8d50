// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/data_transfer/device/flow_means.hpp"

namespace hirosco {

/// Device frames in a TCP stream (stream_framing.hpp). The device listens at "host:port", of this computer or of a permitted network,
/// and speaks with who connected last; the subsystem connects, and again each reconnect_pause while there is no connection. A frame
/// is sent at once (TCP_NODELAY) or let go: while 64 were not acknowledged none is, and a connection on which nothing is for half a second is left.
/// Errors as find_route(); AlreadyExists: somebody listens there.
[[nodiscard]] Result<std::unique_ptr<DataFlow>> open_tcp_flow(const FlowOpening& opening);

/// To its port, wherever that is.
void let_in_tcp(const std::string& address, Sandbox& sandbox);
[[nodiscard]] bool is_reached_by_tcp(const std::string& address, const Sandbox& sandbox);
inline constexpr FlowAccess tcp_access{
    .let_in = let_in_tcp, .is_reached = is_reached_by_tcp, .own = &own_as_of_one_user};

}  // namespace hirosco
