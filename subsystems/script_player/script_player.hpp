// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

/// Plays scripts of its descriptor: telecommands to other subsystems, one after the other, with waits between them.
[[nodiscard]] std::unique_ptr<Subsystem> make_script_player();

}  // namespace hirosco
