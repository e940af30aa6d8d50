// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "hirosco/utilities/os/processor_set.hpp"

/// Whether the threads of a process are where they may be, seen from outside (docs/adr/0234).
namespace hirosco {

/// Where they may be.
struct ThreadPlaces {
  ProcessorSet all;  ///< each of them
  std::optional<unsigned> cycle{};  ///< and the one of this name alone there
  static constexpr std::string_view cycle_name = "cycle";
  friend bool operator==(const ThreadPlaces&, const ThreadPlaces&) = default;
};

/// A thread that may use a processor that is none of its own.
struct StrayThread {
  std::array<char, 16> name{};
  unsigned processor{0};  ///< that
};

/// Of a process of this computer, whose number is not used anew meanwhile; empty: none, or it has ended. A process of more threads than
/// 256 is looked at as far as that. Realtime: no (docs/adr/0240); no heap.
[[nodiscard]] std::optional<StrayThread> stray_thread(int process, const ThreadPlaces& places) noexcept;

}  // namespace hirosco
