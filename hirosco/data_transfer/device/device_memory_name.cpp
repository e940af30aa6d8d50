// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/device_memory_name.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace hirosco {

std::string device_memory_file(const std::string& address, FlowHolder holder) {
  std::string name = address;
  std::ranges::replace(name, '/', '.');
  return device_memory_folder + ((holder == FlowHolder::Supervisor ? "." : "/") + name);
}

void make_device_memory_folder() {
  namespace fs = std::filesystem;
  std::error_code error;
  // Not as the mask of who comes first has it.
  if (fs::create_directory(device_memory_folder, error))
    fs::permissions(device_memory_folder, fs::perms::all | fs::perms::sticky_bit, error);
}

}  // namespace hirosco
