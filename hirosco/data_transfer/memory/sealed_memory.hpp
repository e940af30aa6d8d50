// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {

/// Shareable memory of the real set: memfd, sealed against resizing when it is made (decision 19). Without state.
/// Realtime: system calls. Thread: any.
class SealedMemory final : public MemoryProvider {
 public:
  [[nodiscard]] Result<MemoryHandle> create(const char* name, std::size_t octets) override;
  /// Mismatch: memory that could shrink under us. NotPermitted: writable after seal_writers.
  [[nodiscard]] Result<Mapping> map(const MemoryHandle& handle, Access access) override;
  [[nodiscard]] Result<> seal_writers(const MemoryHandle& handle) override;
  [[nodiscard]] Result<> verify(const MemoryHandle& handle, std::size_t octets, bool writers_sealed) override;

  /// The descriptor to pass on, owned by the handle; -1 when the handle is not one of a SealedMemory.
  [[nodiscard]] static int descriptor(const MemoryHandle& handle) noexcept;
  /// Takes a descriptor over, unverified: who does not trust its source calls verify() before map().
  [[nodiscard]] static MemoryHandle adopt(int descriptor);
  [[nodiscard]] static MemoryHandle adopt(FileDescriptor descriptor);
};

}  // namespace hirosco
