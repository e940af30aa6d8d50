// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/last_words.hpp"

#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

namespace hirosco {
namespace {

constexpr int exit_environment = 3;
constexpr int longest_wait_ms = 200;

/// The handler has no argument; written once, before any thread is started.
const char*& program_name() noexcept {
  static const char* name = "hirosco";
  return name;
}

void write_words(const char* text) noexcept { static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text))); }

/// Whoever ends is to be gone for those who look after it, though a terminal stands still or nobody reads a pipe.
[[nodiscard]] bool somebody_takes_them() noexcept {
  pollfd look{STDERR_FILENO, POLLOUT, 0};
  return ::poll(&look, 1, longest_wait_ms) == 1 && (look.revents & POLLOUT) != 0;
}

void say(const char* what, const char* detail = "") noexcept {
  if (!somebody_takes_them()) return;
  for (const char* part : {program_name(), ": ", what, detail, "\n"}) write_words(part);
}

[[noreturn]] void last_words() noexcept {
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
    say("ends without an exception");
  } catch (const std::bad_alloc&) {
    say("no memory left");
    std::_Exit(exit_environment);
  } catch (const std::system_error& problem) {
    say("the system refuses what is needed (thread, descriptor): ", problem.what());
    std::_Exit(exit_environment);
  } catch (const std::exception& problem) {
    say("a defect: ", problem.what());
  } catch (...) {
    say("a defect: an exception without words");
  }
  std::abort();
}

}  // namespace

void say_last_words(const char* program) noexcept {
  program_name() = program;
  std::set_terminate(last_words);
}

}  // namespace hirosco
