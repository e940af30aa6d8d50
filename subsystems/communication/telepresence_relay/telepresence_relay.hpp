// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/communication/communication.hpp"

namespace hirosco {

/// A ground link that carries an operator's hand controller, too: its sets up to the robot and the robot's down, late and with losses.
[[nodiscard]] std::unique_ptr<Subsystem> make_telepresence_relay();
/// The same on a transport that is given.
[[nodiscard]] std::unique_ptr<Subsystem> make_telepresence_relay_on(OpenGroundTransport open);

}  // namespace hirosco
