// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What to wait for; the hang-up of the other side is always reported.
enum class Interest : std::uint8_t { Read, Write, ReadWrite, HangUpOnly };

/// One descriptor with something to do.
struct Ready {
  int descriptor{-1};
  bool readable{false};
  bool writable{false};
  bool hung_up{false};  ///< the other side closed, or the descriptor is in error
};

/// Waits until one of a small set of descriptors is ready. It does not own them: remove() before closing.
/// Realtime: blocks; allocates in add() only. Thread: one.
class WaitSet {
 public:
  static constexpr std::size_t max_descriptors = 4096;

  /// AlreadyExists when it is in, ResourceExhausted when the set is full.
  [[nodiscard]] Result<> add(int descriptor, Interest interest = Interest::Read);
  /// Changes what is waited for; NotFound when it is not in.
  [[nodiscard]] Result<> change(int descriptor, Interest interest) noexcept;
  /// Nothing happens when it is not in.
  void remove(int descriptor) noexcept;
  [[nodiscard]] std::size_t size() const noexcept;

  /// The descriptors that are ready, none when `timeout` passed first (without one it waits for ever; 0 only looks).
  /// Signals do not end the wait. The span is valid until the next call on the set.
  [[nodiscard]] Result<std::span<const Ready>> wait(std::optional<Duration> timeout) noexcept;

 private:
  struct Entry {
    int descriptor;
    short events;
    short returned;
  };
  [[nodiscard]] std::size_t index_of(int descriptor) const noexcept;

  std::vector<Entry> entries_;  ///< laid out as pollfd
  std::vector<Ready> ready_;
};

/// Waits for one descriptor alone, with the resolution of the clock; false when `timeout` passed first. Signals do not end the wait.
/// Realtime: blocks, no heap. Thread: any.
[[nodiscard]] bool wait_readable(int descriptor, Duration timeout) noexcept;

/// Wakes a thread in WaitSet::wait(): its descriptor is readable from notify() until clear(); several notifications
/// before that are one.
/// Realtime: notify() is bounded (one system call). Thread: notify() any, clear() the waiting one.
class WakeEvent {
 public:
  [[nodiscard]] static Result<WakeEvent> create() noexcept;
  void notify() noexcept;
  void clear() noexcept;
  [[nodiscard]] int descriptor() const noexcept { return read_end_.get(); }

 private:
  WakeEvent(FileDescriptor read_end, FileDescriptor write_end) noexcept
      : read_end_{std::move(read_end)}, write_end_{std::move(write_end)} {}
  FileDescriptor read_end_;
  FileDescriptor write_end_;  ///< none where one descriptor serves both ends
};

}  // namespace hirosco
