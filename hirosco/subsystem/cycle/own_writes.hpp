// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/dictionary.hpp"

namespace hirosco {

/// Which parameters the author's node writes itself: what anybody else sets there would not last beyond the next cycle.
/// Thread: the cycle's, but has(); begin() while it rests.
class OwnWrites {
 public:
  OwnWrites(const descriptor::SubsystemDescriptor& descriptor, const Dictionary& dictionary);

  /// Another configuration: no cycle of it has run. Allocates.
  void begin();
  /// Before the node.  Realtime: wait-free.
  void note_stores() noexcept;
  /// After it.  Realtime: wait-free.
  void note_own_writes() noexcept;
  /// Whether the node wrote this parameter in the newest cycle; by its place in the descriptor.  Realtime: wait-free. Thread: any.
  [[nodiscard]] bool has(std::size_t parameter) const noexcept {
    return parameter < parameters_ && own_writes_[parameter].load(std::memory_order_relaxed) != 0;
  }

 private:
  struct Watched {
    const ParameterCell* cell;
    std::uint64_t stores;  ///< before the node ran
    std::uint16_t parameter;
  };
  const descriptor::SubsystemDescriptor& descriptor_;
  const Dictionary& dictionary_;
  std::vector<Watched> watched_;  ///< what ST[20] might set
  std::unique_ptr<std::atomic<std::uint8_t>[]> own_writes_;  ///< by parameter
  std::size_t parameters_{0};
};

}  // namespace hirosco
