// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/utilities/os/sandbox.hpp"

namespace hirosco {

/// From now on this process and whatever comes of it makes no system call that no subsystem needs, no sockets and queues but as the sandbox says,
/// and no signals to others (docs/adr/0081, 0146, 0150, 0164). 0, or the system's error number; 0 also where the kernel has no filters (isolation_lacks()).
/// After fork(): signals go to the process that calls it.  Async-signal-safe.
[[nodiscard]] int refuse_calls(const Sandbox& sandbox) noexcept;

}  // namespace hirosco
