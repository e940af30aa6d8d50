// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::supervisor {

/// Folders beside those of device addresses into which one process was let when it started, and that are nobody's address until one is
/// given it (docs/adr/0236): `/dev/shm/hirosco-spare.PID.NUMBER`. Those of a process outlive this object: who goes on for a supervisor finds them
/// by its number. Whatever the process does in them, it is in its own alone.
/// Realtime: blocks. Thread: the supervisor's.
class SpareFolders {
 public:
  SpareFolders() = default;
  SpareFolders(SpareFolders&& other) noexcept;
  SpareFolders& operator=(SpareFolders&& other) noexcept;
  SpareFolders(const SpareFolders&) = delete;
  SpareFolders& operator=(const SpareFolders&) = delete;
  /// Those that belong to no process go.
  ~SpareFolders();
  /// Before the process is: under the number of this one. Fewer where the system refuses them.
  [[nodiscard]] static SpareFolders make(std::size_t wanted);
  /// Those that a process has, whoever made them for it; none of another user.
  [[nodiscard]] static SpareFolders of(int pid);
  /// Away with those of processes that are gone: of flights that were killed as a whole.
  static void sweep();

  [[nodiscard]] const std::vector<std::string>& places() const noexcept { return places_; }
  /// The same for the sandbox of a process that is forked from this one: it finds them whatever their names are by then. Until they belong to one.
  [[nodiscard]] std::vector<std::string> for_sandbox() const;
  /// The process that was let in, or is in this moment.
  void belong_to(int pid);

  /// One that can be used gets the place of that folder, whose frames come along. NotFound: none can be; AlreadyExists: another subsystem has
  /// frames open there; Mismatch: there is something else than frames in it; else errors of exchange_memory_folder().
  [[nodiscard]] Result<> give(const std::string& place);
  /// The folder at that place is one of these again, and another of the same rights is there in its place, with its frames. What is not there
  /// is nobody's. Errors of exchange_memory_folder(): it stays there.
  [[nodiscard]] Result<> take_back(const std::string& place);
  /// Its process has ended, or never was. What it has put into one stays.
  void remove();

 private:
  [[nodiscard]] std::string free_name() const;

  int pid_{0};
  bool belong_{false};  ///< to a process; else to this object
  std::vector<std::string> places_;
  std::vector<FileDescriptor> opened_;  ///< while they belong to no process
};

}  // namespace hirosco::supervisor
