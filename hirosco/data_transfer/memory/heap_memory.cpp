// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/memory/heap_memory.hpp"

#include <array>
#include <atomic>
#include <vector>

namespace hirosco {
namespace {

struct alignas(64) Line {
  std::array<std::byte, 64> octets{};
};

struct HeapBlock final : MemoryHandle::Block {
  explicit HeapBlock(std::size_t size) : lines((size + sizeof(Line) - 1) / sizeof(Line)), octets{size} {}
  std::vector<Line> lines;
  std::size_t octets;
  std::atomic<bool> sealed{false};
};

std::shared_ptr<HeapBlock> block_of(const MemoryHandle& handle) {
  return std::dynamic_pointer_cast<HeapBlock>(handle.block());
}

constexpr auto foreign = "memory handle is not of this provider";

}  // namespace

Result<MemoryHandle> HeapMemory::create(const char*, std::size_t octets) {
  if (octets == 0 || octets > max_octets)
    return fail(ErrorCode::InvalidArgument, "octets of shared memory", static_cast<std::int64_t>(octets));
  return MemoryHandle{std::make_shared<HeapBlock>(octets)};
}

Result<Mapping> HeapMemory::map(const MemoryHandle& handle, Access access) {
  const auto block = block_of(handle);
  if (!block) return fail(ErrorCode::InvalidArgument, foreign);
  if (access == Access::ReadWrite && block->sealed)
    return fail(ErrorCode::NotPermitted, "shared memory is sealed against writers");
  return Mapping{block, MutableOctets{block->lines[0].octets.data(), block->octets}};
}

Result<> HeapMemory::seal_writers(const MemoryHandle& handle) {
  const auto block = block_of(handle);
  if (!block) return fail(ErrorCode::InvalidArgument, foreign);
  block->sealed = true;
  return ok();
}

Result<> HeapMemory::verify(const MemoryHandle& handle, std::size_t octets, bool writers_sealed) {
  const auto block = block_of(handle);
  if (!block) return fail(ErrorCode::Mismatch, foreign);
  if (block->octets != octets)
    return fail(ErrorCode::Mismatch, "size of shared memory", static_cast<std::int64_t>(block->octets));
  if (writers_sealed && !block->sealed) return fail(ErrorCode::Mismatch, "seals of shared memory");
  return ok();
}

}  // namespace hirosco
