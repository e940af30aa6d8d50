// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// Processes that are users of their own (docs/adr/0177): the system keeps each from the files, sockets, memory and signals of the others.
namespace hirosco {

/// What this process lacks to start others as users `first` to `last` and to do with those all that it does with its own: end them, take
/// their real-time priority and set its limit, give them folders. In words; empty: nothing.
[[nodiscard]] std::vector<std::string> lacking_for_own_users(std::uint32_t first, std::uint32_t last);

/// This process, of one thread, is user and group `number` from now on, in no other group. Of our rights it keeps what a sandbox leaves
/// root: locked memory, and real time where no limit says which priorities. 0, or the system's error number.
/// For between fork and exec: async-signal-safe, opens no file.
[[nodiscard]] int become_user(std::uint32_t number) noexcept;

/// What this process executes from now on has none of the rights by which others are started as users of their own and are ended. What is
/// root's it has all the same.  Async-signal-safe.
void lay_down_rights_over_users() noexcept;

/// Whose process has a number of these, as "PROGRAM (PID)"; empty: nobody's.  Realtime: no.
[[nodiscard]] std::string process_of_users(std::uint32_t first, std::uint32_t last);

}  // namespace hirosco
