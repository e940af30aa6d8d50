// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "hirosco/utilities/os/stray_thread.hpp"
#include "supervisor/platform/launch/launcher.hpp"
#include "supervisor/supervision/resource_management/book.hpp"

namespace hirosco::supervisor {

/// A book of each core that the mission names (docs/adr/0234): of its time, in percent. Whose it is alone has all of it. Of who shares it
/// stands there what his loops of services take from his start on, as what a cycle takes is asked for with its configuration; one at
/// least, so that nobody has it alone beside him. A core that the computer has not for us has nothing to give. Thread: the supervisor's.
class CoreBooks {
 public:
  static constexpr std::uint32_t all_of_a_core = 100;

  struct CoreShortage {
    std::uint16_t core{0};
    Shortage shortage{};
  };

  /// Mission and launcher outlive it.
  CoreBooks(const descriptor::Mission& mission, ProcessLauncher& launcher);

  /// Of its cycle, and of its other threads, for which it is enough that there is one. Empty: it is promised to it.
  [[nodiscard]] std::optional<CoreShortage> claim(const descriptor::MissionSubsystem& subsystem);
  void release(std::uint16_t apid);
  [[nodiscard]] const Book& book(std::uint16_t core) { return books_[core]; }

  /// A thread of it that may use what is none of its cores, as its process is now; empty: none, or no mission says anything of cores.
  [[nodiscard]] std::optional<StrayThread> stray(const descriptor::MissionSubsystem& subsystem,
                                                 std::uint32_t process) const noexcept;

 private:
  [[nodiscard]] Book& asked(std::uint16_t core);

  ProcessLauncher& launcher_;
  bool named_;  ///< somebody has a core of his own
  ProcessorSet of_flight_{};  ///< whatever is nobody's alone: what this process may use
  std::map<std::uint16_t, Book> books_;
};

}  // namespace hirosco::supervisor
