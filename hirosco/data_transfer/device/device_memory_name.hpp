// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hirosco/data_transfer/device/data_flow.hpp"

/// Where the named memory of devices is (docs/adr/0150).
namespace hirosco {

/// Of the frames of devices, which subsystems open: the one folder of it that a sandbox lets in. What the supervisor's side alone
/// holds is beside it.
inline constexpr const char* device_memory_folder = "/dev/shm/hirosco";

/// The file of a flow: HOLDER's and address decide, "/" becomes ".".
[[nodiscard]] std::string device_memory_file(const std::string& address, FlowHolder holder);

/// Makes the folder unless it is there, as open to all users of the computer as the one that it is in. It stays: who has been let in
/// would not be in another one of that name.  Realtime: blocks, allocates.
void make_device_memory_folder();

}  // namespace hirosco
