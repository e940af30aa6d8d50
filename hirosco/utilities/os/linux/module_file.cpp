// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <link.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <fstream>

#include "hirosco/utilities/os/installation.hpp"

namespace hirosco {

namespace fs = std::filesystem;

/// A shared object ends with the table of its sections. The loader maps one that was cut short, and the process would die at
/// the first access to what is missing.
bool os_detail::module_is_whole(const fs::path& file) {
  ElfW(Ehdr) header{};
  std::ifstream stream{file, std::ios::binary};
  stream.read(reinterpret_cast<char*>(&header), sizeof header);
  if (!stream || !std::equal(header.e_ident, header.e_ident + SELFMAG, std::begin(ELFMAG))) return false;
  std::error_code failed;
  const auto octets = fs::file_size(file, failed);
  return !failed && header.e_shoff > 0 && octets >= header.e_shoff + std::uint64_t{header.e_shnum} * header.e_shentsize;
}

/// A module takes somewhat more than its file.
bool os_detail::has_room_for_module(const fs::path& file) {
  std::error_code failed;
  const std::size_t octets = 2 * fs::file_size(file, failed);
  if (failed) return true;
  void* const room = ::mmap(nullptr, octets, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) return errno != ENOMEM;
  ::munmap(room, octets);
  return true;
}

}  // namespace hirosco
