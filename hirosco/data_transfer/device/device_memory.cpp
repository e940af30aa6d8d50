// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/device_memory.hpp"

#include <sys/stat.h>

#include <algorithm>

namespace hirosco {

std::string device_memory_file(const std::string& address, FlowHolder holder) {
  std::string name = address;
  std::ranges::replace(name, '/', '.');
  return device_memory_folder + ((holder == FlowHolder::Supervisor ? "." : "/") + name);
}

void make_device_memory_folder() noexcept {
  constexpr mode_t for_all = 01777;
  // Not as the mask of who comes first has it.
  if (::mkdir(device_memory_folder, for_all) == 0) static_cast<void>(::chmod(device_memory_folder, for_all));
}

}  // namespace hirosco
