// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/data_transfer/memory/memory.hpp"

namespace hirosco {

/// Shareable memory of the simulated set: blocks of the heap with the rules of the real ones.
/// Realtime: allocates. Thread: any.
class HeapMemory final : public MemoryProvider {
 public:
  static constexpr std::size_t max_octets = 128U << 20;
  [[nodiscard]] Result<MemoryHandle> create(const char* name, std::size_t octets) override;
  /// NotPermitted: writable after seal_writers. InvalidArgument: the handle is not one of a HeapMemory.
  [[nodiscard]] Result<Mapping> map(const MemoryHandle& handle, Access access) override;
  [[nodiscard]] Result<> seal_writers(const MemoryHandle& handle) override;
  [[nodiscard]] Result<> verify(const MemoryHandle& handle, std::size_t octets, bool writers_sealed) override;
};

}  // namespace hirosco
