// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/module.hpp"
#include "subsystems/communication/communication.hpp"

const hirosco::Module* hirosco_module() noexcept {
  return &hirosco::subsystem_module<hirosco::make_communication, hirosco::make_communication_on>;
}
