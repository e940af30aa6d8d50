// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace hirosco {

/// From now on a process that ends by an exception, in whichever of its threads, says on its standard error who it is and
/// what it lacked, without any memory of its own and where somebody takes it: who stands still there keeps nobody alive. It exits with 3 where the computer refused memory, a thread or a
/// descriptor, else it aborts: that is a defect. `program` is kept: argv[0] or a literal.
void say_last_words(const char* program) noexcept;

}  // namespace hirosco
