// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"
#include "supervisor/platform/launch/interpreter.hpp"

namespace hirosco::supervisor {

/// An executable in memory that nobody can change any more, not even who may write the file that it was read from: what was
/// hashed is what is executed, each time (docs/adr/0089).  Thread: any; nothing of it changes.
class ProgramImage {
 public:
  static constexpr std::size_t max_octets = std::size_t{256} << 20;

  /// Reads the file once, to its end. NotPermitted: it may not be read or executed; ResourceExhausted: larger than max_octets, or
  /// no memory; InvalidArgument: no regular file, or empty.  Realtime: blocks, as long as the disk does.
  [[nodiscard]] static Result<ProgramImage> read(const std::filesystem::path& file);

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  [[nodiscard]] const std::string& digest() const noexcept { return digest_; }
  /// For Process::spawn.
  [[nodiscard]] int descriptor() const noexcept { return memory_.get(); }
  [[nodiscard]] std::size_t octets() const noexcept { return octets_; }
  /// Which is a file of its own; nothing: it is no script.
  [[nodiscard]] const std::optional<Interpreter>& interpreter() const noexcept { return interpreter_; }

 private:
  std::filesystem::path file_;
  std::string digest_;
  FileDescriptor memory_;
  std::size_t octets_{0};
  std::optional<Interpreter> interpreter_;
};

}  // namespace hirosco::supervisor
