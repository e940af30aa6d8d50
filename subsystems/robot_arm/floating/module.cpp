// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/module.hpp"
#include "subsystems/robot_arm/floating/floating_arm.hpp"

const hirosco::Module* hirosco_module() noexcept { return &hirosco::subsystem_module<hirosco::make_floating_arm>; }
