// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/line_writer.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <utility>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/semaphore.hpp"

namespace hirosco {
namespace {

constexpr std::size_t writer_stack_octets = std::size_t{256} << 10;
constexpr Duration flush_look = std::chrono::milliseconds{1};
constexpr std::string_view cut_off{"...\n"};

struct WaitingLine {
  std::size_t octets;
  std::array<char, LineWriter::longest> text;
  [[nodiscard]] std::string_view view() const noexcept { return {text.data(), octets}; }
};

}  // namespace

struct LineWriter::State {
  explicit State(int to) noexcept : descriptor{to} {}

  const int descriptor;
  Semaphore news;
  std::atomic<bool> ending{false};
  std::atomic<std::size_t> open{0};  ///< lines that wait or are being written
  std::atomic<std::uint64_t> dropped{0};  ///< since somebody took something last
  Mutex mutex;
  std::size_t first HIROSCO_GUARDED_BY(mutex){0};
  std::size_t count HIROSCO_GUARDED_BY(mutex){0};
  // Not made zero: memory that no line has used yet is none.
  std::array<WaitingLine, most_lines> lines HIROSCO_GUARDED_BY(mutex);

  [[nodiscard]] bool put(std::string_view line) noexcept {
    const LockGuard lock{mutex};
    if (count == most_lines) return false;
    WaitingLine& place = lines[(first + count++) % most_lines];
    place.octets = std::min(line.size(), longest);
    std::memcpy(place.text.data(), line.data(), place.octets);
    if (line.size() > longest)
      std::memcpy(place.text.data() + longest - cut_off.size(), cut_off.data(), cut_off.size());
    open.fetch_add(1);
    return true;
  }
  [[nodiscard]] bool take(WaitingLine& into) noexcept {
    const LockGuard lock{mutex};
    if (count == 0) return false;
    const WaitingLine& place = lines[first];
    into.octets = place.octets;
    std::memcpy(into.text.data(), place.text.data(), place.octets);
    first = (first + 1) % most_lines;
    --count;
    return true;
  }
  /// False: it was not taken to its end.
  [[nodiscard]] bool write_all(std::string_view text) const noexcept {
    while (!text.empty()) {
      const auto octets = ::write(descriptor, text.data(), text.size());
      if (octets < 0 && errno == EINTR) continue;
      if (octets < 0) return false;
      text.remove_prefix(static_cast<std::size_t>(octets));
      if (!text.empty() && ending.load()) return false;
    }
    return true;
  }
  void tell_dropped() noexcept {
    const std::uint64_t lines_dropped = dropped.exchange(0);
    if (lines_dropped == 0) return;
    std::array<char, 96> text;
    const int octets =
        std::snprintf(text.data(), text.size(), "hirosco: %llu lines were not written: nobody took them\n",
                      static_cast<unsigned long long>(lines_dropped));
    if (octets > 0 && !write_all({text.data(), static_cast<std::size_t>(octets)})) dropped.fetch_add(lines_dropped);
  }
  void work() noexcept {
    // Whoever made it may have real-time priority; a terminal is written to by ordinary work.
    static_cast<void>(set_ordinary_scheduling());
    WaitingLine line;
    while (!ending.load()) {
      news.wait();
      while (take(line)) {
        if (!ending.load()) {
          tell_dropped();
          if (!write_all(line.view())) dropped.fetch_add(1);
        }
        open.fetch_sub(1);
      }
    }
  }
};

LineWriter::LineWriter(int descriptor) : state_{new State{descriptor}} {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  if (auto thread = Thread::start("lines", [state = state_] { state->work(); }, writer_stack_octets))
    thread_ = std::move(*thread);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

LineWriter::~LineWriter() {
  const bool all = flush(last_patience);
  state_->ending.store(true);
  state_->news.post();
  if (all) thread_.join();
  else thread_.leave_behind();
}

bool LineWriter::say(std::string_view line) noexcept {
  if (!thread_.joinable()) return false;
  if (!state_->put(line)) {
    state_->dropped.fetch_add(1);
    return false;
  }
  state_->news.post();
  return true;
}

bool LineWriter::flush(Duration limit) noexcept {
  const SystemClock clock;
  for (const TimePoint until = clock.now() + limit; state_->open.load() != 0; sleep_until(clock.now() + flush_look))
    if (clock.now() >= until) return false;
  return true;
}

}  // namespace hirosco
