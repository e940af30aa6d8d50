// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

/// A camera: takes images, keeps the newest, sends them to ground in parts or lends them to who is on board.
[[nodiscard]] std::unique_ptr<Subsystem> make_imager();

}  // namespace hirosco
