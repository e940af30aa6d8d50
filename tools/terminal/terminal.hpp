// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <termios.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"
#include "tools/terminal/screen.hpp"

/// A terminal that a program has to itself for a while. Nothing here waits for one that stands still but restore(), and that not for ever.
namespace hirosco::terminal {

/// How it was before, to be put back by whoever still lives.
class TerminalState {
 public:
  /// Of the terminal at this descriptor; Unavailable: it is none, or another program has it in the foreground.
  [[nodiscard]] static Result<TerminalState> of(int descriptor);
  /// Modes and screen as they were, and these words on it, within `patience`; whoever held its output by Ctrl-S gets it going.
  void restore(Duration patience, std::string_view words = {}) const;

 private:
  friend class Terminal;
  std::string path_;
  termios modes_{};
};

/// The screen of an alternate buffer, with keys one by one. Ctrl-C stays a signal; Ctrl-Z and Ctrl-\ are none.
class Terminal {
 public:
  /// Restored by `state`, whoever does it.
  [[nodiscard]] static Result<Terminal> take(const TerminalState& state);

  [[nodiscard]] int descriptor() const noexcept { return descriptor_.get(); }
  [[nodiscard]] Size size() const;
  /// Modes and an empty screen again, after somebody else had the terminal.
  void begin();
  /// Begins to send; call only when nothing is pending.
  void send(std::string octets) { pending_ += octets; }
  /// Sends as much as it takes now. False: it is gone.
  [[nodiscard]] bool go_on();
  [[nodiscard]] bool pending() const noexcept { return !pending_.empty(); }
  /// Keys that came; empty: none.
  [[nodiscard]] std::string keys();

 private:
  Terminal(FileDescriptor descriptor, const termios& modes) : descriptor_{std::move(descriptor)}, modes_{modes} {}
  FileDescriptor descriptor_;
  termios modes_;
  std::string pending_;  ///< of one picture at most
};

/// Whether letters beyond ASCII are shown, by the variables that a locale is chosen with; a variable that is not set is null.
[[nodiscard]] bool takes_unicode(const char* lc_all, const char* lc_ctype, const char* lang) noexcept;

}  // namespace hirosco::terminal
