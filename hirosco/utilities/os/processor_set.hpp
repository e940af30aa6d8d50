// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// The processors that a thread may use, by the system's numbers from 0. Where the system has no affinity nothing is known of them, a set
/// is empty and nobody can take it.
class ProcessorSet {
 public:
  /// The system's numbers end here, whatever computer it is.
  static constexpr unsigned most = 1024;

  /// None.
  ProcessorSet() = default;
  [[nodiscard]] static ProcessorSet of_this_thread() noexcept;
  /// Of any thread of the computer, by its number; empty: it has ended, or the system does not tell.
  [[nodiscard]] static ProcessorSet of_thread(int thread) noexcept;
  /// Those below `most` alone.
  [[nodiscard]] static ProcessorSet of(std::span<const std::uint16_t> processors) noexcept;

  /// The calling thread may use these, and no others, from now on; those that the computer does not have are left out. Unavailable where
  /// there is no affinity or the set is empty, SystemFailure where the system grants none of them. Realtime: bounded.
  [[nodiscard]] Result<> take() const noexcept;
  [[nodiscard]] bool has(unsigned processor) const noexcept;
  void add(unsigned processor) noexcept;
  void remove(unsigned processor) noexcept;
  void add(const ProcessorSet& others) noexcept;
  [[nodiscard]] unsigned count() const noexcept;
  [[nodiscard]] std::optional<unsigned> last() const noexcept;
  /// One that is not among `others`; the lowest.
  [[nodiscard]] std::optional<unsigned> beyond(const ProcessorSet& others) const noexcept;
  friend bool operator==(const ProcessorSet&, const ProcessorSet&) = default;

 private:
  static constexpr unsigned word_bits = 8 * sizeof(unsigned long);
  std::array<unsigned long, most / word_bits> words_{};  ///< the lowest processor in the lowest bit, as Linux has them
};

/// "0, 2", as people read them.
[[nodiscard]] std::string to_string(const ProcessorSet& processors);
/// Whether the system lets the calling thread use this processor: tried, and undone. Realtime: bounded.
[[nodiscard]] bool grants_processor(unsigned processor) noexcept;

}  // namespace hirosco
