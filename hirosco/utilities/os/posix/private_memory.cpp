// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/private_memory.hpp"

#include <sys/mman.h>

#include <cstring>

namespace hirosco {

Result<PrivateMemory> PrivateMemory::take(std::size_t octets) noexcept {
  // MAP_ANONYMOUS came into the standard in 2024; every system of ours has had it since long before.
  void* const start =
      octets == 0 ? MAP_FAILED : ::mmap(nullptr, octets, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (start == MAP_FAILED)
    return fail(ErrorCode::ResourceExhausted, "memory of the system", static_cast<std::int64_t>(octets));
  std::memset(start, 0, octets);
  return PrivateMemory{{static_cast<std::byte*>(start), octets}};
}

PrivateMemory::~PrivateMemory() {
  if (!octets_.empty()) static_cast<void>(::munmap(octets_.data(), octets_.size()));
}

}  // namespace hirosco
