// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/module.hpp"
#include "subsystems/communication/telepresence_relay/telepresence_relay.hpp"

const hirosco::Module* hirosco_module() noexcept {
  return &hirosco::subsystem_module<hirosco::make_telepresence_relay, hirosco::make_telepresence_relay_on>;
}
