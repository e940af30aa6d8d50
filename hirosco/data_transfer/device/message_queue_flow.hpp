// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/flow_access.hpp"

namespace hirosco {

/// Device frames by two POSIX message queues of one computer, "/hirosco.ADDRESS.to_device" and "/hirosco.ADDRESS.to_subsystem", made by
/// who comes first and removed by who goes last. A full queue loses its oldest frame for the newest. A side is who has the lock on
/// the queue that it reads: the system frees it with the process.
/// `address`: 1 .. 200 characters, "/" becomes ".". AlreadyExists: another live flow has this side.
[[nodiscard]] Result<std::unique_ptr<DataFlow>> open_message_queue_flow(const std::string& address, FlowSide side);

/// All queues of the user: no rule tells one from another, and none is a user's of its own: it belongs to who comes first.
void let_in_queues(const std::string& address, Sandbox& sandbox);
[[nodiscard]] bool is_reached_by_queues(const std::string& address, const Sandbox& sandbox);
inline constexpr FlowAccess message_queue_access{let_in_queues, is_reached_by_queues};

}  // namespace hirosco
