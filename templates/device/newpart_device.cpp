// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "newpart_device.hpp"

#include <simulation/devices/module.hpp>

const hirosco::Module* hirosco_module() noexcept { return &hirosco::simulation::device_module<NewPartDevice>; }
