// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/author/ground_transport.hpp"

namespace hirosco {

/// Below the ground link: TCP sockets, where the environment or the descriptor says.
[[nodiscard]] Result<std::unique_ptr<GroundTransport>> open_tcp_transport(GroundTraffic& traffic);

}  // namespace hirosco
