// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

/// The force-reflecting joystick of the demonstrator (paper 5): stand-alone it shows a commanded torque, coupled the
/// forces that the robot meets.
[[nodiscard]] std::unique_ptr<Subsystem> make_joystick();

}  // namespace hirosco
