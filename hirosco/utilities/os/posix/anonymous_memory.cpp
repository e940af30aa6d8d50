// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>

#include "hirosco/utilities/os/shared_memory.hpp"

namespace hirosco {

Result<FileDescriptor> os_detail::anonymous_memory(const char* /*label*/, std::size_t octets) noexcept {
  // A name that lives for one call; a process that dies in between leaves one behind, hence the number of tries.
  constexpr int tries = 1000;
  for (int i = 0; i < tries; ++i) {
    std::array<char, 48> name{};
    (void)std::snprintf(name.data(), name.size(), "/hirosco-%ld-%d", static_cast<long>(::getpid()), i);
    FileDescriptor descriptor{::shm_open(name.data(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600)};
    if (!descriptor && errno == EEXIST) continue;
    if (!descriptor) return fail(ErrorCode::SystemFailure, "anonymous shared memory", errno);
    (void)::shm_unlink(name.data());
    HIROSCO_TRY(give_size(descriptor.get(), octets));
    return descriptor;
  }
  return fail(ErrorCode::ResourceExhausted, "names for anonymous shared memory", tries);
}

}  // namespace hirosco
