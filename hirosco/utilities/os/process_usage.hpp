// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/process_threads.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What a process has taken of its computer; of threads of one process 0 is what cannot be told apart.
struct ProcessUsage {
  std::uint32_t memory_kb{0};  ///< that it may write and shares with nobody, in RAM or not: what its limit counts
  std::uint32_t resident_kb{0};  ///< in RAM, whosever it is
  std::uint32_t shared_memory_kb{0};  ///< in RAM
  std::uint32_t threads{0};
  std::uint32_t descriptors{0};  ///< 0 where they cannot be counted: of another process
  Duration processor{};  ///< of all its threads since its start
  std::uint32_t processes{
      1};  ///< itself, and of another process those that it has started and that have not ended, where the system tells; a hundred are enough
  std::uint32_t look{
      0};  ///< how often it was looked at, where somebody else does that; 0: not yet, and only its processor time is known
  static constexpr std::uint16_t no_core = 0xFFFF;
  std::uint16_t cycle_core{no_core};  ///< on which its cycle is alone, where whoever asks knows that
};

/// Looks at one process again and again. Realtime: of ourselves system calls, bounded, no heap; of others no (docs/adr/0240).
/// Thread: one at a time.
class ProcessMeter {
 public:
  /// Of ourselves; NotFound: the system does not tell.
  [[nodiscard]] static Result<ProcessMeter> own() noexcept;
  /// Of another one, whose number is not used anew as long as its parent has not taken its end.
  [[nodiscard]] static Result<ProcessMeter> of(int pid) noexcept;
  /// Empty: it has ended.
  [[nodiscard]] std::optional<ProcessUsage> look() noexcept;

 private:
  enum class Whose : std::uint8_t { Own, Others };
  ProcessMeter(FileDescriptor status, ProcessThreads threads, Whose whose, int clock) noexcept
      : status_{std::move(status)}, threads_{std::move(threads)}, whose_{whose}, clock_{clock} {}
  FileDescriptor status_;
  ProcessThreads threads_;  ///< of another one
  Whose whose_;
  int clock_;  ///< of its processor time
};

/// What this process has freed goes back to the system, as far as the C library holds on to it: for one that has read much and does little
/// from then on. Not real-time.
void give_back_what_is_free() noexcept;

/// Of the lines that the system tells of a process: the number behind "NAME:"; 0 when there is none, the largest when it is larger.
[[nodiscard]] std::uint32_t number_in_status(std::string_view status, std::string_view name) noexcept;

}  // namespace hirosco
