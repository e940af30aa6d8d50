// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::memfd {

/// New zeroed memory that can neither grow nor shrink; `label` shows in /proc. Map it by MappedMemory.
[[nodiscard]] Result<FileDescriptor> create(const char* label, std::size_t octets) noexcept;
/// From now on nobody can write or map it writable; writable mappings that exist stay.
[[nodiscard]] Result<> seal_writers(int descriptor) noexcept;
/// Mismatch unless the object has exactly this size, cannot be resized and, if `writers_sealed`, has no future writers.
/// What comes from another process is verified before it is mapped: otherwise a truncation there is a fault here.
[[nodiscard]] Result<> verify(int descriptor, std::size_t octets, bool writers_sealed) noexcept;

}  // namespace hirosco::memfd
