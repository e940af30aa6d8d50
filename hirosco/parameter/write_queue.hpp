// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hirosco/parameter/dictionary.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// One parameter, or one member of it, to be set.
struct ParameterWrite {
  std::uint16_t index{};
  int member{-1};               ///< -1: the whole parameter
  Octets value;                 ///< big-endian, packed
};

/// Parameter writes on their way to the cycle: only the cycle writes parameters while it runs (docs/adr/0003). A batch
/// holds all writes of one request; they take effect together, at one cycle boundary, and other threads see either none
/// or all changes of one parameter.
class WriteQueue {
 public:
  /// Room for `batches` batches of `octets_per_batch` octets each, allocated here and never again. A write takes
  /// 12 octets besides its value, a batch 4.
  WriteQueue(std::size_t batches, std::size_t octets_per_batch);

  /// Takes the whole batch or nothing: refuses writes that the dictionary does not accept, a batch larger than its
  /// place (OutOfRange) and a full queue (ResourceExhausted).
  /// Realtime: blocks (other enqueuers only, priority inheritance). Thread: any but the cycle's.
  [[nodiscard]] Result<> enqueue(const Dictionary& dictionary, std::span<const ParameterWrite> writes);

  /// Applies every batch that was complete at the call; returns their number.
  /// Realtime: wait-free, at most `batches` batches. Thread: the writer's.
  std::size_t apply(Dictionary& dictionary) noexcept;

  /// Asks `good` of each write that waits, oldest first, until it says no; whether it never did. What the writer applies meanwhile is asked of,
  /// too: whoever reads values after this has seen each either here or there.
  /// Realtime: blocks (as enqueue()). Thread: any but the cycle's.
  [[nodiscard]] bool all_waiting(const std::function<bool(const ParameterWrite&)>& good);

  /// Batches waiting.  Realtime: wait-free. Thread: any.
  [[nodiscard]] std::size_t waiting() const noexcept {
    return static_cast<std::size_t>(filled_.load(std::memory_order_acquire) - applied_.load(std::memory_order_acquire));
  }

 private:
  [[nodiscard]] MutableOctets place(std::uint64_t number) noexcept {
    return MutableOctets{storage_}.subspan((number % batches_) * octets_per_batch_, octets_per_batch_);
  }

  std::size_t batches_;
  std::size_t octets_per_batch_;
  std::vector<std::byte> storage_;
  Mutex enqueuers_;
  alignas(64) std::atomic<std::uint64_t> filled_{0};  // written by enqueuers, under the mutex
  alignas(64) std::atomic<std::uint64_t> applied_{0};  // written by the cycle
};

}  // namespace hirosco
