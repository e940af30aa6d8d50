// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// Memory of this process alone, of the system and not of the heap, which may keep what is given back to it. Its destructor gives it
/// back to the system at once.  Thread: its owner.
class PrivateMemory {
 public:
  /// Zeroed, and in RAM: no later access waits for it. ResourceExhausted, with how many octets: the system has no such memory, or
  /// a limit of this process forbids it.
  [[nodiscard]] static Result<PrivateMemory> take(std::size_t octets) noexcept;
  PrivateMemory() = default;
  PrivateMemory(PrivateMemory&& other) noexcept : octets_{std::exchange(other.octets_, {})} {}
  PrivateMemory& operator=(PrivateMemory&& other) noexcept {
    std::swap(octets_, other.octets_);
    return *this;
  }
  PrivateMemory(const PrivateMemory&) = delete;
  PrivateMemory& operator=(const PrivateMemory&) = delete;
  ~PrivateMemory();

  /// Page-aligned.
  [[nodiscard]] MutableOctets octets() const noexcept { return octets_; }

 private:
  explicit PrivateMemory(MutableOctets octets) noexcept : octets_{octets} {}
  MutableOctets octets_;
};

}  // namespace hirosco
