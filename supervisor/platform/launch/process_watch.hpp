// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/process_usage.hpp"
#include "hirosco/utilities/os/semaphore.hpp"
#include "hirosco/utilities/os/stray_thread.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/platform/launch/launcher.hpp"

namespace hirosco::supervisor {

/// Looks at processes by a thread without real time: whoever walks their files with it can be held there for good, by whom he has displaced
/// or by one that ends (docs/adr/0240). Each question is answered by what was seen last, and has it looked at again; nothing here but its end
/// waits for that thread, which may not come to run for as long as others take all processors.
/// Realtime: bounded; add() and remove() allocate. Thread: the supervisor's.
class ProcessWatch {
 public:
  ProcessWatch();
  ~ProcessWatch();
  ProcessWatch(const ProcessWatch&) = delete;
  ProcessWatch& operator=(const ProcessWatch&) = delete;

  /// False: there was no thread to be had, and nothing is ever seen of anybody.
  [[nodiscard]] bool looks() const noexcept { return thread_.joinable(); }
  /// From now on.
  /// \param handle Readable once it has ended, as Process::handle().
  /// \param grip Learns from time to time which threads it has; may be null.
  void add(std::uint32_t number, int pid, FileDescriptor handle, std::shared_ptr<ProcessGrip> grip);
  void remove(std::uint32_t number);

  /// Empty: it has ended, or is none of these. Its processor time is that of now.
  [[nodiscard]] std::optional<ProcessUsage> usage(std::uint32_t number) noexcept;
  /// As it was seen last by these places; empty: none, or it was not looked at by them yet.
  [[nodiscard]] std::optional<StrayThread> stray(std::uint32_t number, const ThreadPlaces& places) noexcept;

 private:
  struct Watched {
    int pid{0};
    FileDescriptor handle{};  ///< readable: it has ended
    std::shared_ptr<ProcessGrip> grip{};
    int clock{0};
    bool asked{false};
    std::optional<ThreadPlaces> places{};
    ProcessUsage usage{};
    std::optional<StrayThread> stray{};
    std::optional<ProcessMeter> meter{};  ///< of the thread that looks alone
  };
  void ask(Watched& watched) noexcept HIROSCO_REQUIRES(mutex_);
  void run();
  [[nodiscard]] std::shared_ptr<Watched> next();
  void look(Watched& watched);

  Mutex mutex_;
  std::map<std::uint32_t, std::shared_ptr<Watched>> watched_ HIROSCO_GUARDED_BY(mutex_);
  std::uint32_t turn_ HIROSCO_GUARDED_BY(mutex_){0};  ///< who was looked at last: each has its turn
  Semaphore asked_;
  std::atomic<bool> ending_{false};
  Thread thread_;
};

}  // namespace hirosco::supervisor
