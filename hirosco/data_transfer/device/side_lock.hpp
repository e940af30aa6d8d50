// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// Whose a side of a flow is that lives in named files which both sides have open: whoever has the lock on an octet of
/// a file. The system frees it with the process, however that ends.
namespace hirosco {

/// A lock of the open file, not of the process: also two flows of one process exclude each other. False: another has it.
/// Realtime: one system call.
[[nodiscard]] bool lock_side(int file, std::size_t octet) noexcept;
void free_side(int file, std::size_t octet) noexcept;
[[nodiscard]] bool is_locked_by_another(int file, std::size_t octet) noexcept;

/// A moment, 0.1 ms, in which a peer that closes or opens comes to its end.
void pause_for_peer() noexcept;

/// The turn to close, that only one side has at a time. Whoever closes takes it first, then looks whether he is the last (the lock on
/// the peer's side is his for the asking), and has freed his own side before he frees the turn: without it two that close at once
/// would each find the other still there, and the name would remain.
/// False: another has had it for 20 ms, someone stopped in the middle of it; then a name may remain, which the next flight uses.
/// Realtime: blocks, not for longer than that.
[[nodiscard]] bool take_turn_to_close(int file, std::size_t octet) noexcept;

}  // namespace hirosco
