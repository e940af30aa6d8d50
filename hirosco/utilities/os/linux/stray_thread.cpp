// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/stray_thread.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>

#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {
namespace {

constexpr int most_looked_at = 256;

[[nodiscard]] FileDescriptor tasks_of(int process) noexcept {
  std::array<char, 40> path{};
  auto end = std::ranges::copy(std::string_view{"/proc/"}, path.begin()).out;
  end = std::to_chars(end, path.end(), process).ptr;
  std::ranges::copy(std::string_view{"/task"}, end);
  return FileDescriptor{::open(path.data(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
}

/// As the tools of the system show it; empty: it has ended.
[[nodiscard]] std::array<char, 16> name_of(int tasks, const char* thread) noexcept {
  constexpr std::string_view file = "/comm";
  std::array<char, 32 + file.size()> path{};
  std::array<char, 16> name{};
  const std::string_view number{thread};
  if (number.size() + file.size() >= path.size()) return name;
  std::ranges::copy(file, std::ranges::copy(number, path.begin()).out);
  const FileDescriptor text{::openat(tasks, path.data(), O_RDONLY | O_CLOEXEC)};
  const auto octets = text ? ::read(text.get(), name.data(), name.size()) : 0;
  // It ends with a new line, which a name of 15 octets leaves room for.
  if (octets > 0) name[static_cast<std::size_t>(octets) - 1] = '\0';
  return name;
}

[[nodiscard]] std::optional<StrayThread> look(int tasks, const char* thread, const ThreadPlaces& places) noexcept {
  const ProcessorSet used = ProcessorSet::of_thread(std::atoi(thread));
  auto beyond = used.beyond(places.all);
  if (!beyond && places.cycle) {
    ProcessorSet own;
    own.add(*places.cycle);
    beyond = used.beyond(own);
    if (beyond && std::string_view{name_of(tasks, thread).data()} != ThreadPlaces::cycle_name) return std::nullopt;
  }
  if (!beyond) return std::nullopt;
  return StrayThread{.name = name_of(tasks, thread), .processor = *beyond};
}

}  // namespace

std::optional<StrayThread> stray_thread(int process, const ThreadPlaces& places) noexcept {
  const FileDescriptor tasks = tasks_of(process);
  if (!tasks) return std::nullopt;
  int looked_at = 0;
  // Not by readdir(), which takes from the heap.
  alignas(dirent64) std::array<char, 2048> entries;
  for (ssize_t octets = 0; (octets = ::getdents64(tasks.get(), entries.data(), entries.size())) > 0;)
    for (ssize_t at = 0; at < octets;) {
      const auto* const entry = reinterpret_cast<const dirent64*>(entries.data() + at);
      at += entry->d_reclen;
      if (entry->d_name[0] == '.') continue;
      if (++looked_at > most_looked_at) return std::nullopt;
      if (const auto stray = look(tasks.get(), entry->d_name, places)) return stray;
    }
  return std::nullopt;
}

}  // namespace hirosco
