// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "hirosco/parameter/native_layout.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco {

/// Takes the fields of an object as they stand on the wire, big-endian and packed, into it. False when the octets are not exactly
/// theirs: the object is then as it was.  Realtime: bounded.
[[nodiscard]] bool take_fields(Octets wire, std::span<const NativeField> fields, MutableOctets object) noexcept;

}  // namespace hirosco
