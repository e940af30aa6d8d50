// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <limits>
#include <utility>

namespace hirosco {
namespace {

[[nodiscard]] ErrorCode code_of(int error) noexcept {
  switch (error) {
    case ENOENT: return ErrorCode::NotFound;
    case EEXIST: return ErrorCode::AlreadyExists;
    case EACCES:
    case EPERM: return ErrorCode::NotPermitted;
    case ENOSPC:
    case ENOMEM:
    case EMFILE:
    case ENFILE: return ErrorCode::ResourceExhausted;
    default: return ErrorCode::SystemFailure;
  }
}

[[nodiscard]] bool plausible(std::size_t octets) noexcept {
  return octets != 0 && octets <= static_cast<std::size_t>(std::numeric_limits<off_t>::max());
}

}  // namespace

Result<> os_detail::give_size(int descriptor, std::size_t octets) noexcept {
  int error = 0;
  do {
    error = ::posix_fallocate(descriptor, 0, static_cast<off_t>(octets));
  } while (error == EINTR);
  if (error != 0) return fail(code_of(error), "size of shared memory", error);
  return ok();
}

Result<MappedMemory> MappedMemory::map(int descriptor, std::size_t octets, MapMode mode) noexcept {
  if (!plausible(octets)) return fail(ErrorCode::InvalidArgument, "octets to map");
  struct stat status{};
  if (::fstat(descriptor, &status) != 0) return fail(ErrorCode::SystemFailure, "size of memory to map", errno);
  if (status.st_size < static_cast<off_t>(octets))
    return fail(ErrorCode::Mismatch, "memory to map is shorter", status.st_size);
  const int protection = mode == MapMode::ReadOnly ? PROT_READ : PROT_READ | PROT_WRITE;
  void* start = ::mmap(nullptr, octets, protection, MAP_SHARED, descriptor, 0);
  if (start == MAP_FAILED) return fail(code_of(errno), "map memory", errno);
  return MappedMemory{{static_cast<std::byte*>(start), octets}};
}

MappedMemory::MappedMemory(MappedMemory&& other) noexcept : octets_{std::exchange(other.octets_, {})} {}

MappedMemory& MappedMemory::operator=(MappedMemory&& other) noexcept {
  if (this == &other) return *this;
  reset();
  octets_ = std::exchange(other.octets_, {});
  return *this;
}

void MappedMemory::reset() noexcept {
  if (!octets_.empty()) (void)::munmap(octets_.data(), octets_.size());
  octets_ = {};
}

Result<SharedMemory> SharedMemory::create(const char* name, std::size_t octets) noexcept {
  if (!plausible(octets)) return fail(ErrorCode::InvalidArgument, "octets of shared memory");
  FileDescriptor descriptor{::shm_open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600)};
  if (!descriptor) return fail(code_of(errno), "create shared memory", errno);
  Result<> sized = os_detail::give_size(descriptor.get(), octets);
  auto made = sized ? from_descriptor(std::move(descriptor), octets, MapMode::ReadWrite) : fail(sized.error());
  if (!made) (void)::shm_unlink(name);
  return made;
}

Result<SharedMemory> SharedMemory::open(const char* name, std::size_t octets, MapMode mode) noexcept {
  FileDescriptor descriptor{::shm_open(name, (mode == MapMode::ReadOnly ? O_RDONLY : O_RDWR) | O_CLOEXEC, 0)};
  if (!descriptor) return fail(code_of(errno), "open shared memory", errno);
  return from_descriptor(std::move(descriptor), octets, mode);
}

Result<> SharedMemory::unlink(const char* name) noexcept {
  if (::shm_unlink(name) != 0) return fail(code_of(errno), "remove shared memory", errno);
  return ok();
}

Result<SharedMemory> SharedMemory::create_anonymous(const char* label, std::size_t octets) noexcept {
  if (!plausible(octets)) return fail(ErrorCode::InvalidArgument, "octets of shared memory");
  HIROSCO_TRY_LET(FileDescriptor descriptor, os_detail::anonymous_memory(label, octets));
  return from_descriptor(std::move(descriptor), octets, MapMode::ReadWrite);
}

Result<SharedMemory> SharedMemory::from_descriptor(FileDescriptor descriptor, std::size_t octets,
                                                   MapMode mode) noexcept {
  HIROSCO_TRY_LET(MappedMemory memory, MappedMemory::map(descriptor.get(), octets, mode));
  return SharedMemory{std::move(descriptor), std::move(memory)};
}

}  // namespace hirosco
