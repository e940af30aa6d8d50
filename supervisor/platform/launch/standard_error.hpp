// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/line_writer.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::supervisor {

/// Nothing but what can be printed: control characters and what is not ASCII as `\x1b`.
[[nodiscard]] std::string shown(std::string_view text);

/// At most so many lines of one speaker from turn to turn; those held back are counted exactly.  Thread: one.
class LineLimit {
 public:
  explicit LineLimit(std::size_t most) : most_{most} {}
  [[nodiscard]] bool admit(std::string_view speaker);
  /// Begins the next turn: who had more to say, and how many lines of it were not shown.
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> turn();

 private:
  std::size_t most_;
  std::map<std::string, std::uint64_t, std::less<>> said_;
};

/// Puts the octets of one stream together to lines of bounded length.  Thread: one.
class LineCutter {
 public:
  static constexpr std::size_t longest = 400;
  /// Calls `line` for each line that is complete; the rest of one that is too long is cut off, with "..." in its place.
  void take(std::string_view octets, const std::function<void(std::string_view)>& line);
  /// What stands without an end.
  void end(const std::function<void(std::string_view)>& line);

 private:
  std::string pending_;
  bool cut_{false};
};

/// The standard errors of the subsystems: each line is printed with its speaker's name, at most `most_lines` of one speaker
/// in a second, the rest as a count. One ordinary thread, which goes on reading though nobody takes what it prints: else who writes would
/// wait, and that is a subsystem.
class StandardError {
 public:
  static constexpr std::size_t most_lines = 20;
  using Print = std::function<void(const std::string&)>;
  /// `print` is called by the thread and must not wait for anybody; by default standard error, by a LineWriter.
  explicit StandardError(Print print = {});
  ~StandardError();
  StandardError(const StandardError&) = delete;
  StandardError& operator=(const StandardError&) = delete;

  /// The end that a new process gets as its standard error.
  /// `reader`: another descriptor of the end that is read here, for who goes on reading it.
  [[nodiscard]] Result<FileDescriptor> open(const std::string& speaker, FileDescriptor* reader = nullptr);
  /// Goes on reading what somebody else had opened. What is no pipe is not read.
  void go_on(const std::string& speaker, FileDescriptor reader);

 private:
  struct Stream {
    std::string speaker;
    FileDescriptor end;
    LineCutter cutter;
  };
  void follow(const std::string& speaker, FileDescriptor reader);
  void work();
  void read_from(Stream& stream, LineLimit& limit);
  void say(const std::string& speaker, std::string_view line, LineLimit& limit);

  std::optional<LineWriter> writer_;
  Print print_;
  std::mutex mutex_;
  std::vector<Stream> fresh_;
  std::atomic<bool> ending_{false};
  FileDescriptor wake_read_;
  FileDescriptor wake_write_;
  std::thread thread_;
};

}  // namespace hirosco::supervisor
