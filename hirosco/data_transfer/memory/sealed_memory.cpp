// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/memory/sealed_memory.hpp"

#include <sys/stat.h>

#include <cerrno>

#include "hirosco/utilities/os/linux/memfd.hpp"
#include "hirosco/utilities/os/shared_memory.hpp"

namespace hirosco {
namespace {

struct SealedBlock final : MemoryHandle::Block {
  explicit SealedBlock(FileDescriptor owned) : descriptor{std::move(owned)} {}
  FileDescriptor descriptor;
};

constexpr auto foreign_handle = "memory handle is not of this provider";

Result<std::size_t> size_of(int descriptor) noexcept {
  struct stat status{};
  if (::fstat(descriptor, &status) != 0) return fail(ErrorCode::SystemFailure, "size of shared memory", errno);
  if (status.st_size <= 0) return fail(ErrorCode::Mismatch, "size of shared memory", status.st_size);
  return static_cast<std::size_t>(status.st_size);
}

}  // namespace

Result<MemoryHandle> SealedMemory::create(const char* name, std::size_t octets) {
  HIROSCO_TRY_LET(FileDescriptor descriptor, memfd::create(name, octets));
  return adopt(std::move(descriptor));
}

Result<Mapping> SealedMemory::map(const MemoryHandle& handle, Access access) {
  const int number = descriptor(handle);
  if (number < 0) return fail(ErrorCode::InvalidArgument, foreign_handle);
  HIROSCO_TRY_LET(const std::size_t octets, size_of(number));
  HIROSCO_TRY(memfd::verify(number, octets, false));
  HIROSCO_TRY_LET(
      MappedMemory memory,
      MappedMemory::map(number, octets, access == Access::ReadOnly ? MapMode::ReadOnly : MapMode::ReadWrite));
  auto keep = std::make_shared<MappedMemory>(std::move(memory));
  const MutableOctets all = keep->octets();
  return Mapping{std::move(keep), all};
}

Result<> SealedMemory::seal_writers(const MemoryHandle& handle) {
  const int number = descriptor(handle);
  if (number < 0) return fail(ErrorCode::InvalidArgument, foreign_handle);
  return memfd::seal_writers(number);
}

Result<> SealedMemory::verify(const MemoryHandle& handle, std::size_t octets, bool writers_sealed) {
  const int number = descriptor(handle);
  if (number < 0) return fail(ErrorCode::Mismatch, foreign_handle);
  return memfd::verify(number, octets, writers_sealed);
}

int SealedMemory::descriptor(const MemoryHandle& handle) noexcept {
  const auto* const block = dynamic_cast<const SealedBlock*>(handle.block().get());
  return block == nullptr ? -1 : block->descriptor.get();
}

MemoryHandle SealedMemory::adopt(int descriptor) { return adopt(FileDescriptor{descriptor}); }

MemoryHandle SealedMemory::adopt(FileDescriptor descriptor) {
  return MemoryHandle{std::make_shared<SealedBlock>(std::move(descriptor))};
}

}  // namespace hirosco
