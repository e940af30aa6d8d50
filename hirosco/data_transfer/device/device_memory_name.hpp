// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/utilities/result.hpp"

/// Where the named memory of devices is (docs/adr/0150, 0169). An address is one with the flight's instance in it.
namespace hirosco {

/// Where the folders of all device addresses are; no sandbox lets anybody in here. What the supervisor's side alone holds is beside it.
inline constexpr const char* device_memory_root = "/dev/shm/hirosco";

/// Of the frames of one device address: what a sandbox lets in whose device that is, and nobody else. "/" becomes ".".
[[nodiscard]] std::string device_memory_folder(const std::string& address);

/// The file of a flow: HOLDER's and address decide.
[[nodiscard]] std::string device_memory_file(const std::string& address, FlowHolder holder);

/// Makes the folder unless it is there, as open to all users of the computer as the one that it is in. It stays: who has been let in
/// would not be in another one of that name. InvalidArgument: an address that names no folder of its own; Mismatch: a file stands there,
/// or a link, by which whoever is let in would be elsewhere.  Realtime: blocks, allocates.
[[nodiscard]] Result<> make_device_memory_folder(const std::string& address);

/// Where nobody who was let in lives any more; one with frames in it stays.  Realtime: blocks, allocates.
void remove_device_memory_folder(const std::string& address);

}  // namespace hirosco
