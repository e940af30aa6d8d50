// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/device/serial_line.hpp"

namespace hirosco {

/// Device frames on a serial line (stream_framing.hpp), 8 bits, no parity, one stop bit, no flow control. A path below /dev is opened by
/// either side. Any other is a pseudo-terminal: the device makes one and leaves a symbolic link of that name to it, as it does for whoever
/// comes; the subsystem follows it. A line that is not there, or hangs up, is looked for again each reconnect_pause. A frame is let go
/// while the one before has not gone out. AlreadyExists: a living pseudo-terminal has the name, or another process the line.
/// Realtime: but for a driver that takes its time to open a line that was plugged in again.
[[nodiscard]] Result<std::unique_ptr<DataFlow>> open_serial_flow(const FlowOpening& opening);

/// Which pseudo-terminal a name leads to is known when it is there: all of them.
void let_in_serial(const std::string& address, Sandbox& sandbox);
[[nodiscard]] bool is_reached_by_serial(const std::string& address, const Sandbox& sandbox);
/// Of a user of its own: a line that the computer gives it, and no pseudo-terminal.
[[nodiscard]] std::string_view why_not_own_serial(const std::string& address);
inline constexpr OwnFlowAccess own_serial_access{.why_not = why_not_own_serial};
inline constexpr FlowAccess serial_access{
    .let_in = let_in_serial, .is_reached = is_reached_by_serial, .own = &own_serial_access};

}  // namespace hirosco
