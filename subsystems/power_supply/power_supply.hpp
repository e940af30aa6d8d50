// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

/// Measures array, battery and loads, and tells what electrical power there is for everybody.
[[nodiscard]] std::unique_ptr<Subsystem> make_power_supply();

}  // namespace hirosco
