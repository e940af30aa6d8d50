// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/process_threads.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>

namespace hirosco {

ProcessThreads ProcessThreads::of(int process) noexcept {
  std::array<char, 40> path{};
  auto end = std::ranges::copy(std::string_view{"/proc/"}, path.begin()).out;
  end = std::to_chars(end, path.end(), process).ptr;
  std::ranges::copy(std::string_view{"/task"}, end);
  return ProcessThreads{FileDescriptor{::open(path.data(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)}};
}

FileDescriptor ProcessThreads::open(int thread, std::string_view file) const noexcept {
  std::array<char, 40> path{};
  auto end = std::to_chars(path.begin(), path.end(), thread).ptr;
  if (file.size() + 2 > static_cast<std::size_t>(path.end() - end)) return {};
  *end++ = '/';
  std::ranges::copy(file, end);
  return FileDescriptor{::openat(folder_.get(), path.data(), O_RDONLY | O_CLOEXEC)};
}

bool ProcessThreads::rewind() noexcept { return folder_ && ::lseek(folder_.get(), 0, SEEK_SET) == 0; }

std::size_t ProcessThreads::next(std::span<int, 64> numbers) noexcept {
  // Not by readdir(), which takes from the heap. An entry has 24 octets at least: never more than there is room for.
  alignas(dirent64) std::array<char, 64 * 24> entries;
  std::size_t count = 0;
  // "." and ".." are no threads, and not the end either.
  while (count == 0) {
    const auto octets = ::getdents64(folder_.get(), entries.data(), entries.size());
    if (octets <= 0) return 0;
    for (ssize_t at = 0; at < octets;) {
      const auto* const entry = reinterpret_cast<const dirent64*>(entries.data() + at);
      at += entry->d_reclen;
      const std::string_view name{entry->d_name};
      int thread = 0;
      std::from_chars(name.data(), name.data() + name.size(), thread);
      if (thread > 0) numbers[count++] = thread;
    }
  }
  return count;
}

}  // namespace hirosco
