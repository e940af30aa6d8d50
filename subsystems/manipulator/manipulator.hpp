// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/subsystem.hpp"

namespace hirosco {

/// The two-joint robot of the demonstrator (paper 5): stand-alone on MOVE_TO, coupled on the joystick's position.
[[nodiscard]] std::unique_ptr<Subsystem> make_manipulator();

}  // namespace hirosco
