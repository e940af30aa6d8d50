// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <string>

namespace hirosco::terminal {
namespace {

constexpr std::string_view begin_screen = "\x1b[?1049h\x1b[?7l\x1b[?25l\x1b[0m\x1b[2J";
constexpr std::string_view end_screen = "\x1b[0m\x1b[?25h\x1b[?7h\x1b[?1049l";

/// An open file of its own: that it does not block is not to be seen by whoever has the terminal, too.
[[nodiscard]] FileDescriptor open_unblocked(const std::string& path) {
  return FileDescriptor{::open(path.c_str(), O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)};
}

}  // namespace

Result<TerminalState> TerminalState::of(int descriptor) {
  TerminalState state;
  std::array<char, 256> name{};
  if (::isatty(descriptor) == 0 || ::ttyname_r(descriptor, name.data(), name.size()) != 0)
    return fail(ErrorCode::Unavailable, "not a terminal", errno);
  state.path_ = name.data();
  if (::tcgetpgrp(descriptor) != ::getpgrp()) return fail(ErrorCode::Unavailable, "in the background");
  if (::tcgetattr(descriptor, &state.modes_) != 0) return fail(ErrorCode::Unavailable, "modes of the terminal", errno);
  const FileDescriptor mine = open_unblocked(state.path_);
  if (!mine) return fail(ErrorCode::Unavailable, "terminal cannot be opened", errno);
  return state;
}

void TerminalState::restore(Duration patience, std::string_view words) const {
  const FileDescriptor mine = open_unblocked(path_);
  if (!mine) return;
  // Without these keys nothing is held by them any more.
  termios flowing = modes_;
  flowing.c_iflag &= ~static_cast<tcflag_t>(IXON);
  ::tcsetattr(mine.get(), TCSANOW, &flowing);
  const auto until = std::chrono::steady_clock::now() + patience;
  const std::string whole = std::string{end_screen} + std::string{words};
  std::string_view left{whole};
  while (!left.empty() && std::chrono::steady_clock::now() < until) {
    const auto sent = ::write(mine.get(), left.data(), left.size());
    if (sent > 0) left.remove_prefix(static_cast<std::size_t>(sent));
    else if (errno == EAGAIN || errno == EINTR) {
      pollfd wanted{mine.get(), POLLOUT, 0};
      ::poll(&wanted, 1, 20);
    } else break;
  }
  ::tcsetattr(mine.get(), TCSANOW, &modes_);
}

Result<Terminal> Terminal::take(const TerminalState& state) {
  FileDescriptor mine = open_unblocked(state.path_);
  if (!mine) return fail(ErrorCode::Unavailable, "terminal cannot be opened", errno);
  termios modes = state.modes_;
  modes.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | IEXTEN);
  modes.c_cc[VMIN] = 1;
  modes.c_cc[VTIME] = 0;
  for (const int key : {VSUSP, VQUIT}) modes.c_cc[key] = _POSIX_VDISABLE;
  Terminal terminal{std::move(mine), modes};
  terminal.begin();
  return terminal;
}

void Terminal::begin() {
  ::tcsetattr(descriptor_.get(), TCSANOW, &modes_);
  pending_ = begin_screen;
}

Size Terminal::size() const {
  constexpr std::size_t most = 1000;  // whatever it says, a picture has its bound
  winsize told{};
  if (::ioctl(descriptor_.get(), TIOCGWINSZ, &told) != 0 || told.ws_col == 0 || told.ws_row == 0) return {};
  return {std::min<std::size_t>(told.ws_col, most), std::min<std::size_t>(told.ws_row, most)};
}

bool Terminal::go_on() {
  while (!pending_.empty()) {
    const auto sent = ::write(descriptor_.get(), pending_.data(), pending_.size());
    if (sent > 0) pending_.erase(0, static_cast<std::size_t>(sent));
    else if (sent < 0 && errno == EINTR) continue;
    else return sent < 0 && errno == EAGAIN;
  }
  return true;
}

std::string Terminal::keys() {
  std::array<char, 256> octets;
  const auto got = ::read(descriptor_.get(), octets.data(), octets.size());
  return got > 0 ? std::string(octets.data(), static_cast<std::size_t>(got)) : std::string{};
}

bool takes_unicode(const char* lc_all, const char* lc_ctype, const char* lang) noexcept {
  for (const char* said : {lc_all, lc_ctype, lang}) {
    if (said == nullptr || *said == '\0') continue;  // the next one counts
    std::string name{said};
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return name.find("utf-8") != std::string::npos || name.find("utf8") != std::string::npos;
  }
  return false;
}

}  // namespace hirosco::terminal
