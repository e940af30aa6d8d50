// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

enum class MapMode : std::uint8_t { ReadOnly, ReadWrite };

/// A range of mapped memory, unmapped by its destructor.  Thread: its owner.
class MappedMemory {
 public:
  /// Maps the first `octets` of `descriptor`, shared; refused when the object is shorter, so that no access faults later.
  [[nodiscard]] static Result<MappedMemory> map(int descriptor, std::size_t octets, MapMode mode) noexcept;
  MappedMemory() = default;
  MappedMemory(MappedMemory&& other) noexcept;
  MappedMemory& operator=(MappedMemory&& other) noexcept;
  MappedMemory(const MappedMemory&) = delete;
  MappedMemory& operator=(const MappedMemory&) = delete;
  ~MappedMemory() { reset(); }

  /// Page-aligned. Of a read-only mapping it must not be written: that faults.
  [[nodiscard]] MutableOctets octets() const noexcept { return octets_; }
  void reset() noexcept;

 private:
  explicit MappedMemory(MutableOctets octets) noexcept : octets_{octets} {}
  MutableOctets octets_;
};

/// Memory shared between processes: zeroed when new, mapped for as long as the object lives. Its descriptor may be
/// handed to another process, which maps it by from_descriptor().
/// Realtime: octets() is wait-free, the rest blocks. Thread: its owner.
class SharedMemory {
 public:
  /// New memory under `name` ("/" and then no further "/"); AlreadyExists when the name is taken.
  [[nodiscard]] static Result<SharedMemory> create(const char* name, std::size_t octets) noexcept;
  /// NotFound without such a name.
  [[nodiscard]] static Result<SharedMemory> open(const char* name, std::size_t octets, MapMode mode) noexcept;
  /// Removes a name; what is mapped stays. NotFound without such a name.
  [[nodiscard]] static Result<> unlink(const char* name) noexcept;
  /// New memory without a name, reached by its descriptor only; `label` shows in tools where the system has them.
  [[nodiscard]] static Result<SharedMemory> create_anonymous(const char* label, std::size_t octets) noexcept;
  [[nodiscard]] static Result<SharedMemory> from_descriptor(FileDescriptor descriptor, std::size_t octets,
                                                            MapMode mode) noexcept;

  [[nodiscard]] MutableOctets octets() const noexcept { return memory_.octets(); }
  [[nodiscard]] const FileDescriptor& descriptor() const noexcept { return descriptor_; }

 private:
  SharedMemory(FileDescriptor descriptor, MappedMemory memory) noexcept
      : descriptor_{std::move(descriptor)}, memory_{std::move(memory)} {}
  FileDescriptor descriptor_;
  MappedMemory memory_;
};

namespace os_detail {
/// The backend's memory without a name: of `octets`, zeroed, backed, not mapped.
[[nodiscard]] Result<FileDescriptor> anonymous_memory(const char* label, std::size_t octets) noexcept;
/// Gives new memory its size and its pages, so that a full system refuses here and does not fault later.
[[nodiscard]] Result<> give_size(int descriptor, std::size_t octets) noexcept;
}  // namespace os_detail

}  // namespace hirosco
