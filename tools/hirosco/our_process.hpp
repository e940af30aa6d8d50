// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/utilities/os/process.hpp"

namespace hirosco::tools {

/// The process of this number, as the keeper of a flight; empty: it has ended, whether or not whoever had started it has heard of that, or the
/// number is by now none of our programs.
[[nodiscard]] std::optional<Process> our_process(int number);
/// The one of ours that listens at the other end of this connection of a UNIX socket, though it may stand still; empty: it is none of ours, or the
/// connection has ended.
[[nodiscard]] std::optional<Process> our_listener(int socket);

}  // namespace hirosco::tools
