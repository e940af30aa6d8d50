// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "hirosco/subsystem/author/ground_transport.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

/// The communication subsystem of the demonstrator (paper 5): the ground link, by TCP.
[[nodiscard]] std::unique_ptr<Subsystem> make_communication();
/// The same on a transport that is given.
[[nodiscard]] std::unique_ptr<Subsystem> make_communication_on(OpenGroundTransport open);

}  // namespace hirosco
