// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::supervisor {

/// SHA-256 (FIPS 180-4) as 64 hexadecimal digits, lower case.
/// Realtime: allocates, as long as the octets are many.
[[nodiscard]] std::string sha256(Octets octets);

}  // namespace hirosco::supervisor
