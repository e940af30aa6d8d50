// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/time.hpp"
#include "tools/terminal/terminal.hpp"

/// The screen beside a flight: a process of its own at a low rank, which reads by two pipes what the flight tells. Whatever becomes of it,
/// nobody of the flight waits for it.
namespace hirosco::terminal {

/// Where hirosco-screen finds its pipes: what the supervisor tells, and what every other process prints.
inline constexpr int screen_told_descriptor = 3;
inline constexpr int screen_others_descriptor = 4;

class FlightScreen {
 public:
  /// Whether a screen can be there: a terminal of this process's own that understands more than lines.
  [[nodiscard]] static bool possible();
  /// Starts it. From here on what this process and its children print goes there, but for errors that were going elsewhere already.
  /// Empty: there is none, and all is as before.
  [[nodiscard]] static std::optional<FlightScreen> start(const std::filesystem::path& log);
  FlightScreen(FlightScreen&& other) noexcept;
  FlightScreen& operator=(FlightScreen&&) = delete;
  ~FlightScreen() { end(); }

  /// For what the supervisor tells, in a thread that may wait.
  [[nodiscard]] int told() const noexcept { return told_.get(); }
  [[nodiscard]] int process() const noexcept { return process_; }
  /// The flight is over: the terminal is as it was, after a moment at most.
  void end();

 private:
  FlightScreen() = default;
  FileDescriptor told_, others_;
  /// Of the pipe that everybody prints to: as long as somebody could read it, printing ends nobody.
  FileDescriptor unread_;
  FileDescriptor output_, errors_;  ///< as they were
  std::optional<TerminalState> state_;
  int process_{-1};
};

}  // namespace hirosco::terminal
