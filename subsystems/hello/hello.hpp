// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

/// The smallest useful subsystem (missions/hello): a place to start reading.
[[nodiscard]] std::unique_ptr<Subsystem> make_hello();

}  // namespace hirosco
