// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/standard_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco::supervisor {

namespace {
constexpr std::chrono::seconds turn_time{1};
}

std::string shown(std::string_view text) {
  std::string clean;
  for (const char letter : text) {
    if (letter >= ' ' && letter <= '~') clean += letter;
    else if (letter == '\t') clean += ' ';
    else clean += fmt::format("\\x{:02x}", static_cast<unsigned>(static_cast<unsigned char>(letter)));
  }
  return clean;
}

bool LineLimit::admit(std::string_view speaker) {
  auto found = said_.find(speaker);
  if (found == said_.end()) found = said_.emplace(std::string{speaker}, 0).first;
  return ++found->second <= most_;
}

std::vector<std::pair<std::string, std::uint64_t>> LineLimit::turn() {
  std::vector<std::pair<std::string, std::uint64_t>> held;
  for (const auto& [speaker, lines] : said_)
    if (lines > most_) held.emplace_back(speaker, lines - most_);
  said_.clear();
  return held;
}

void LineCutter::take(std::string_view octets, const std::function<void(std::string_view)>& line) {
  for (const char letter : octets) {
    if (letter == '\n') {
      end(line);
      continue;
    }
    if (pending_.size() < longest) pending_ += letter;
    else cut_ = true;
  }
}

void LineCutter::end(const std::function<void(std::string_view)>& line) {
  if (cut_) pending_ += "...";
  if (!pending_.empty()) line(pending_);
  pending_.clear();
  cut_ = false;
}

StandardError::StandardError(Print print) : print_{std::move(print)} {
  if (!print_) {
    writer_.emplace(STDERR_FILENO);
    print_ = [this](const std::string& line) { writer_->say(line); };
  }
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) return;
  wake_read_.reset(ends[0]);
  wake_write_.reset(ends[1]);
}

StandardError::~StandardError() {
  ending_ = true;
  const char any = 0;
  static_cast<void>(!::write(wake_write_.get(), &any, 1));
  if (thread_.joinable()) thread_.join();
}

Result<FileDescriptor> StandardError::open(const std::string& speaker, FileDescriptor* reader) {
  if (!wake_read_) return fail(ErrorCode::ResourceExhausted, "a pipe for the standard error of subsystems");
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return fail(ErrorCode::SystemFailure, "a pipe for a standard error", errno);
  FileDescriptor reading{ends[0]};
  FileDescriptor writing{ends[1]};
  // Only our end: a subsystem that writes faster than we read waits.
  static_cast<void>(::fcntl(reading.get(), F_SETFL, O_NONBLOCK));
  if (reader != nullptr)
    if (auto second = reading.duplicate()) *reader = std::move(*second);
  follow(speaker, std::move(reading));
  return writing;
}

void StandardError::go_on(const std::string& speaker, FileDescriptor reader) {
  struct stat found{};
  if (!wake_read_ || ::fstat(reader.get(), &found) != 0 || !S_ISFIFO(found.st_mode)) return;
  follow(speaker, std::move(reader));
}

void StandardError::follow(const std::string& speaker, FileDescriptor reader) {
  {
    const std::lock_guard guard{mutex_};
    fresh_.push_back({speaker, std::move(reader), {}});
  }
  if (!thread_.joinable()) thread_ = std::thread{[this] { work(); }};
  const char any = 0;
  static_cast<void>(!::write(wake_write_.get(), &any, 1));
}

void StandardError::say(const std::string& speaker, std::string_view line, LineLimit& limit) {
  if (limit.admit(speaker)) print_(fmt::format("{}: {}\n", speaker, shown(line)));
}

/// Closes the stream when its last writer is gone.
void StandardError::read_from(Stream& stream, LineLimit& limit) {
  const auto line = [&](std::string_view text) { say(stream.speaker, text, limit); };
  std::array<char, 65'536> buffer;
  const auto got = ::read(stream.end.get(), buffer.data(), buffer.size());
  if (got > 0) return stream.cutter.take({buffer.data(), static_cast<std::size_t>(got)}, line);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  stream.cutter.end(line);
  stream.end.reset();
}

void StandardError::work() {
  // Whoever starts subsystems has real-time priority; this thread must not.
  static_cast<void>(set_ordinary_scheduling());
  std::vector<Stream> streams;
  std::vector<pollfd> waits;
  LineLimit limit{most_lines};
  auto next_turn = std::chrono::steady_clock::now() + turn_time;
  const auto tell_held = [&] {
    for (const auto& [speaker, lines] : limit.turn())
      print_(fmt::format("{}: {} more lines in this second are not shown\n", speaker, lines));
  };
  for (bool last = false; !last;) {
    last = ending_;  // what stands in the pipes then is still read
    {
      const std::lock_guard guard{mutex_};
      for (Stream& stream : fresh_) streams.push_back(std::move(stream));
      fresh_.clear();
    }
    waits.assign(1, {wake_read_.get(), POLLIN, 0});
    for (const Stream& stream : streams) waits.push_back({stream.end.get(), POLLIN, 0});
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next_turn - std::chrono::steady_clock::now());
    static_cast<void>(::poll(waits.data(), waits.size(), last ? 0 : static_cast<int>(std::max<long>(left.count(), 0))));
    std::array<char, 64> ignored;
    static_cast<void>(!::read(wake_read_.get(), ignored.data(), ignored.size()));
    for (Stream& stream : streams) read_from(stream, limit);
    std::erase_if(streams, [](const Stream& stream) { return !stream.end; });
    if (std::chrono::steady_clock::now() < next_turn) continue;
    next_turn = std::chrono::steady_clock::now() + turn_time;
    tell_held();
  }
  // What is left without an end; a pipe never holds more than one reading takes.
  for (Stream& stream : streams) stream.cutter.end([&](std::string_view text) { say(stream.speaker, text, limit); });
  tell_held();
}

}  // namespace hirosco::supervisor
