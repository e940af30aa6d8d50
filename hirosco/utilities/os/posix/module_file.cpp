// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/installation.hpp"

// POSIX says nothing of what a shared object looks like in its file, nor what it will take: the loader's own word has to do.
namespace hirosco {

bool os_detail::module_is_whole(const std::filesystem::path& file) {
  std::error_code failed;
  return std::filesystem::file_size(file, failed) > 0 && !failed;
}

bool os_detail::has_room_for_module(const std::filesystem::path& /*file*/) { return true; }

}  // namespace hirosco
