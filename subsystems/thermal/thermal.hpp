// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

/// Keeps the zones of a craft warm enough by their heaters, within a power that is all that it may draw.
[[nodiscard]] std::unique_ptr<Subsystem> make_thermal();

}  // namespace hirosco
