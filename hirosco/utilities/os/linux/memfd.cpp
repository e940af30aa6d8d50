// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/linux/memfd.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>

#include "hirosco/utilities/os/shared_memory.hpp"

namespace hirosco {
namespace memfd {

Result<FileDescriptor> create(const char* label, std::size_t octets) noexcept {
  if (octets == 0) return fail(ErrorCode::InvalidArgument, "octets of shared memory");
  FileDescriptor descriptor{::memfd_create(label, MFD_CLOEXEC | MFD_ALLOW_SEALING)};
  if (!descriptor) return fail(ErrorCode::SystemFailure, "memfd", errno);
  HIROSCO_TRY(os_detail::give_size(descriptor.get(), octets));
  if (::fcntl(descriptor.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) != 0)
    return fail(ErrorCode::SystemFailure, "seal size of memfd", errno);
  return descriptor;
}

Result<> seal_writers(int descriptor) noexcept {
  // Then nobody can add a seal either: who holds the descriptor cannot take anything away from who has it mapped.
  if (::fcntl(descriptor, F_ADD_SEALS, F_SEAL_FUTURE_WRITE) != 0 || ::fcntl(descriptor, F_ADD_SEALS, F_SEAL_SEAL) != 0)
    return fail(ErrorCode::SystemFailure, "seal writers of memfd", errno);
  return ok();
}

Result<> verify(int descriptor, std::size_t octets, bool writers_sealed) noexcept {
  struct stat status{};
  if (::fstat(descriptor, &status) != 0) return fail(ErrorCode::SystemFailure, "size of memfd", errno);
  if (status.st_size < 0 || static_cast<std::size_t>(status.st_size) != octets)
    return fail(ErrorCode::Mismatch, "size of shared memory", status.st_size);
  const int seals = ::fcntl(descriptor, F_GET_SEALS);
  if (seals < 0) return fail(ErrorCode::Mismatch, "shared memory cannot be sealed", errno);
  const int wanted = F_SEAL_SHRINK | F_SEAL_GROW | (writers_sealed ? F_SEAL_FUTURE_WRITE : 0);
  if ((seals & wanted) != wanted) return fail(ErrorCode::Mismatch, "seals of shared memory", seals);
  return ok();
}

}  // namespace memfd

Result<FileDescriptor> os_detail::anonymous_memory(const char* label, std::size_t octets) noexcept {
  return memfd::create(label, octets);
}

}  // namespace hirosco
