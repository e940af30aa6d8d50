// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// Makes the folder of the frames of a device address (device_memory_name.hpp) for a subsystem that is a user of its own: a private one
/// (private_folder.hpp) of ours and that group. One that was open to all becomes that, or goes where it was another user's, and with it frames
/// that nobody has open. Mismatch: somebody has them open from before, or it is another user's, in `value`; else as make_device_memory_folder().
/// Realtime: blocks, allocates.
[[nodiscard]] Result<> make_private_memory_folder(const std::string& address, std::uint32_t group);

}  // namespace hirosco
