// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// Lines to a descriptor whose other end may stand still (a terminal under Ctrl-S, a pipe that nobody reads) from who must not: an
/// ordinary thread of its own writes them, and nobody waits for that. The descriptor is shared with other processes, so it is left as it
/// is: O_NONBLOCK would be theirs, too, and what poll() says of it another writer may have used up. Takes no signal, SIGPIPE included.
class LineWriter {
 public:
  static constexpr std::size_t most_lines = 64;  ///< that wait; what comes beyond them is dropped and counted
  static constexpr std::size_t longest = 2048;  ///< octets; the rest of a line is cut off, with "..." in its place
  static constexpr Duration last_patience = std::chrono::milliseconds{200};

  /// Where the system has no thread for it all lines are dropped. `descriptor` stays open as long as the process.
  explicit LineWriter(int descriptor);
  /// Gives what waits `last_patience`, then leaves it and, where the other end still holds it, the thread behind.
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  /// One line with its end. False: it was dropped.
  /// Realtime: allocates nothing; waits for no more than a copy of one line, under a mutex with priority inheritance. Thread: any.
  bool say(std::string_view line) noexcept;
  /// Whether all that was said has been written, or given up, within this time. Realtime: blocks.
  bool flush(Duration limit) noexcept;

 private:
  struct State;
  std::shared_ptr<State> state_;  ///< the thread's, too, which may outlive this object
  Thread thread_;
};

}  // namespace hirosco
