// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// Owns one piece of shareable memory (real: a memfd; simulated: a block of the heap). Copies refer to the same memory.
class MemoryHandle {
 public:
  /// How a provider keeps its memory; others do not look inside.
  struct Block {
    virtual ~Block() = default;
  };
  MemoryHandle() = default;
  explicit MemoryHandle(std::shared_ptr<Block> block) : block_{std::move(block)} {}
  [[nodiscard]] explicit operator bool() const noexcept { return block_ != nullptr; }
  [[nodiscard]] const std::shared_ptr<Block>& block() const noexcept { return block_; }

 private:
  std::shared_ptr<Block> block_;
};

/// Memory mapped into this process; unmapped with the last copy. `octets` is 64-octet aligned.
struct Mapping {
  std::shared_ptr<void> keep;
  MutableOctets octets;  ///< of a read-only mapping: must not be written (real: faults)
};

enum class Access : std::uint8_t { ReadOnly, ReadWrite };

/// Makes and maps shareable memory (architecture: links, vital and permit pages).  Realtime: allocates.
class MemoryProvider {
 public:
  virtual ~MemoryProvider() = default;
  /// New zeroed memory that can neither grow nor shrink. `name` shows in system tools only.
  [[nodiscard]] virtual Result<MemoryHandle> create(const char* name, std::size_t octets) = 0;
  [[nodiscard]] virtual Result<Mapping> map(const MemoryHandle& handle, Access access) = 0;
  /// From now on nobody can make another writable mapping. The producer calls it after it has mapped.
  [[nodiscard]] virtual Result<> seal_writers(const MemoryHandle& handle) = 0;
  /// Mismatch unless the memory has exactly this size, cannot be resized and, if `writers_sealed`, has no future writers.
  [[nodiscard]] virtual Result<> verify(const MemoryHandle& handle, std::size_t octets, bool writers_sealed) = 0;
};

}  // namespace hirosco
