// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/joystick/self_check.hpp"

namespace hirosco {

/// The force-reflecting joystick of the demonstrator (paper 5): stand-alone it shows a commanded torque, coupled the
/// forces that the robot meets.
[[nodiscard]] std::unique_ptr<Subsystem> make_joystick();
/// The same by another law, which tests plant.
[[nodiscard]] std::unique_ptr<Subsystem> make_joystick_with(joystick::Law law);

}  // namespace hirosco
