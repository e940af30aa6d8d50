// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

/// Attitude and orbit control of a free craft: tells where the base is, and in a configuration with wheels keeps its attitude.
[[nodiscard]] std::unique_ptr<Subsystem> make_aocs();

}  // namespace hirosco
