// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/flight_screen.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

#include "hirosco/utilities/os/installation.hpp"

namespace hirosco::terminal {
namespace {

constexpr Duration orderly_end = 3s;
constexpr Duration forced_end = 2s;

struct Pipe {
  FileDescriptor read, write;
};
[[nodiscard]] Pipe make_pipe() {
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {};
  return {FileDescriptor{ends[0]}, FileDescriptor{ends[1]}};
}

/// In the group of this process, in the foreground of its terminal: its keys come there, and Ctrl-C to all.
[[nodiscard]] int spawn(const std::string& program, std::vector<std::string> words, int told, int others) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t how;
  if (::posix_spawn_file_actions_init(&files) != 0) return -1;
  ::posix_spawnattr_init(&how);
  ::posix_spawn_file_actions_adddup2(&files, told, screen_told_descriptor);
  ::posix_spawn_file_actions_adddup2(&files, others, screen_others_descriptor);
  sigset_t none;
  sigemptyset(&none);
  ::posix_spawnattr_setsigmask(&how, &none);
  ::posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGMASK);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = -1;
  if (::posix_spawn(&process, program.c_str(), &files, &how, arguments.data(), environ) != 0) process = -1;
  ::posix_spawn_file_actions_destroy(&files);
  ::posix_spawnattr_destroy(&how);
  return process;
}

/// Whether the process ended within the time.
[[nodiscard]] bool ended(int process, Duration limit) {
  const auto until = std::chrono::steady_clock::now() + limit;
  for (;;) {
    const pid_t got = ::waitpid(process, nullptr, WNOHANG);
    if (got != 0) return true;
    if (std::chrono::steady_clock::now() >= until) return false;
    const timespec pause{0, 5'000'000};
    ::nanosleep(&pause, nullptr);
  }
}

/// Numbers up to those that the screen finds its pipes under are not to be in their way.
[[nodiscard]] FileDescriptor moved_up(FileDescriptor from) {
  FileDescriptor moved{::fcntl(from.get(), F_DUPFD_CLOEXEC, screen_others_descriptor + 1)};
  return moved;
}

}  // namespace

bool FlightScreen::possible() {
  const char* kind = std::getenv("TERM");
  return kind != nullptr && *kind != '\0' && std::strcmp(kind, "dumb") != 0 &&
         TerminalState::of(STDOUT_FILENO).has_value();
}

std::optional<FlightScreen> FlightScreen::start(const std::filesystem::path& log) {
  const auto program = find_program("hirosco-screen");
  auto state = TerminalState::of(STDOUT_FILENO);
  Pipe told = make_pipe();
  Pipe others = make_pipe();
  if (program.empty() || !state || !told.read || !others.read) return std::nullopt;
  const FileDescriptor told_read = moved_up(std::move(told.read));
  FlightScreen screen;
  screen.unread_ = moved_up(std::move(others.read));
  screen.state_ = std::move(*state);
  std::fflush(stdout);
  screen.process_ =
      spawn(program.string(), {program.string(), "--keeper", std::to_string(::getpid()), "--log", log.string()},
            told_read.get(), screen.unread_.get());
  if (screen.process_ < 0) return std::nullopt;
  screen.told_ = std::move(told.write);
  screen.others_ = std::move(others.write);
  // Whoever prints is never held up; what has no room any more is lost.
  ::fcntl(screen.others_.get(), F_SETFL, O_NONBLOCK);
  screen.output_.reset(::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3));
  ::dup2(screen.others_.get(), STDOUT_FILENO);
  if (::isatty(STDERR_FILENO) != 0) {
    screen.errors_.reset(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3));
    ::dup2(screen.others_.get(), STDERR_FILENO);
  }
  return screen;
}

FlightScreen::FlightScreen(FlightScreen&& other) noexcept
    : told_{std::move(other.told_)},
      others_{std::move(other.others_)},
      unread_{std::move(other.unread_)},
      output_{std::move(other.output_)},
      errors_{std::move(other.errors_)},
      state_{std::move(other.state_)},
      process_{std::exchange(other.process_, -1)} {}

void FlightScreen::end() {
  if (process_ < 0) return;
  std::fflush(stdout);
  if (output_) ::dup2(output_.get(), STDOUT_FILENO);
  if (errors_) ::dup2(errors_.get(), STDERR_FILENO);
  told_.reset();
  others_.reset();
  bool over = ended(process_, orderly_end);
  if (!over) {
    ::kill(process_, SIGTERM);
    over = ended(process_, forced_end);
  }
  if (!over) {
    ::kill(process_, SIGKILL);
    static_cast<void>(ended(process_, forced_end));
    state_->restore(forced_end);
  }
  process_ = -1;
  unread_.reset();
}

}  // namespace hirosco::terminal
