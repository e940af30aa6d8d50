// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ground/archive/archive.hpp"
#include "ground/model/catalogue.hpp"
#include "hirosco/pus/packet/packet.hpp"

/// Telecommands that somebody else has sent, in the words of our own history.
namespace hirosco::ground {

/// Who sends under a source id, as far as our programs keep to ranges of their own (ground/api/README.md).
[[nodiscard]] std::string sender_of(std::uint16_t source);

/// Function and arguments by the descriptors; "TC[20,3]" for other services, no arguments where they cannot be read.
[[nodiscard]] StoredCommand command_of(const Catalogue& catalogue, const pus::TelecommandView& telecommand);

}  // namespace hirosco::ground
