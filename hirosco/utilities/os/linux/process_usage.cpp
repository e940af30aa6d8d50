// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/process_usage.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <malloc.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace hirosco {
namespace {

constexpr std::uint32_t most_counted = std::numeric_limits<std::uint32_t>::max();
/// Who has so many has too many, and each that is looked at takes time.
constexpr std::uint32_t most_children = 100;

/// Its size is their number since Linux 6.2; before that they are not counted.
[[nodiscard]] std::uint32_t own_descriptors() noexcept {
  struct stat folder{};
  return ::stat("/proc/self/fd", &folder) == 0 ? static_cast<std::uint32_t>(folder.st_size) : 0;
}

/// Whether it does anything yet: one that has ended and that nobody waits for keeps its number, and nothing else.
[[nodiscard]] bool goes_on(std::uint32_t process) noexcept {
  std::array<char, 32> path{};
  auto end = std::ranges::copy(std::string_view{"/proc/"}, path.begin()).out;
  end = std::to_chars(end, path.end(), process).ptr;
  std::ranges::copy(std::string_view{"/stat"}, end);
  const FileDescriptor file{::open(path.data(), O_RDONLY | O_CLOEXEC)};
  std::array<char, 512> text;
  const auto octets = file ? ::read(file.get(), text.data(), text.size()) : 0;
  if (octets <= 0) return false;
  // "PID (NAME) STATE ..."; the name may hold anything.
  const std::string_view line{text.data(), static_cast<std::size_t>(octets)};
  const auto name_end = line.rfind(") ");
  return name_end == line.npos || name_end + 2 >= line.size() ||
         (line[name_end + 2] != 'Z' && line[name_end + 2] != 'X');
}

/// Of one thread, at most `most`. The system tells their numbers, each with a blank behind it.
[[nodiscard]] std::uint32_t children_of(int tasks, const char* thread, std::uint32_t most) noexcept {
  constexpr std::string_view file = "/children";
  std::array<char, 32 + file.size()> path{};
  const std::string_view name{thread};
  if (name.size() + file.size() >= path.size()) return 0;
  std::ranges::copy(file, std::ranges::copy(name, path.begin()).out);
  const FileDescriptor children{::openat(tasks, path.data(), O_RDONLY | O_CLOEXEC)};
  if (!children) return 0;
  std::uint32_t count = 0, process = 0;  // a number may begin in one piece and end in the next
  std::array<char, 512> text;
  for (ssize_t octets = 0; (octets = ::read(children.get(), text.data(), text.size())) > 0;)
    for (const char each : std::span{text}.first(static_cast<std::size_t>(octets))) {
      if (each >= '0' && each <= '9') process = 10 * process + static_cast<std::uint32_t>(each - '0');
      else if (goes_on(std::exchange(process, 0U)) && ++count >= most) return count;
    }
  return count;
}

/// Of all threads. Not by readdir(), which takes from the heap.
[[nodiscard]] std::uint32_t children_in(int tasks) noexcept {
  if (tasks < 0 || ::lseek(tasks, 0, SEEK_SET) != 0) return 0;
  std::uint32_t count = 0;
  alignas(dirent64) std::array<char, 2048> entries;
  for (ssize_t octets = 0; (octets = ::getdents64(tasks, entries.data(), entries.size())) > 0;)
    for (ssize_t at = 0; at < octets;) {
      const auto* const entry = reinterpret_cast<const dirent64*>(entries.data() + at);
      if (entry->d_name[0] != '.') count += children_of(tasks, entry->d_name, most_children - count);
      if (count >= most_children) return count;
      at += entry->d_reclen;
    }
  return count;
}

[[nodiscard]] Result<FileDescriptor> open_status(const std::string& process) {
  FileDescriptor status{::open(("/proc/" + process + "/status").c_str(), O_RDONLY | O_CLOEXEC)};
  if (!status) return fail(ErrorCode::NotFound, "status of a process", errno);
  return status;
}

}  // namespace

std::uint32_t number_in_status(std::string_view status, std::string_view name) noexcept {
  for (std::size_t at = status.find(name); at != std::string_view::npos; at = status.find(name, at + 1)) {
    const std::size_t behind = at + name.size();
    if ((at != 0 && status[at - 1] != '\n') || behind >= status.size() || status[behind] != ':') continue;
    const std::size_t digits = status.find_first_not_of(" \t", behind + 1);
    std::uint32_t number = 0;
    if (digits == std::string_view::npos) return 0;
    const auto read = std::from_chars(status.data() + digits, status.data() + status.size(), number);
    return read.ec == std::errc::result_out_of_range ? most_counted : number;
  }
  return 0;
}

void give_back_what_is_free() noexcept {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

Result<ProcessMeter> ProcessMeter::own() {
  HIROSCO_TRY_LET(FileDescriptor status, open_status("self"));
  return ProcessMeter{std::move(status), FileDescriptor{}, Whose::Own, CLOCK_PROCESS_CPUTIME_ID};
}

Result<ProcessMeter> ProcessMeter::of(int pid) {
  HIROSCO_TRY_LET(FileDescriptor status, open_status(std::to_string(pid)));
  FileDescriptor tasks{::open(("/proc/" + std::to_string(pid) + "/task").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  clockid_t clock{};
  if (const int error = ::clock_getcpuclockid(pid, &clock); error != 0)
    return fail(ErrorCode::NotFound, "processor time of a process", error);
  return ProcessMeter{std::move(status), std::move(tasks), Whose::Others, clock};
}

std::optional<ProcessUsage> ProcessMeter::look() noexcept {
  std::array<char, 4096> text;
  const auto octets = ::pread(status_.get(), text.data(), text.size(), 0);
  if (octets <= 0) return std::nullopt;
  const std::string_view status{text.data(), static_cast<std::size_t>(octets)};
  ProcessUsage usage;
  const std::uint32_t data_kb = number_in_status(status, "VmData");
  usage.memory_kb = data_kb + std::min(number_in_status(status, "VmStk"), most_counted - data_kb);
  usage.shared_memory_kb = number_in_status(status, "RssShmem");
  usage.threads = number_in_status(status, "Threads");
  if (whose_ == Whose::Own) usage.descriptors = own_descriptors();
  else usage.processes = 1 + children_in(tasks_.get());
  timespec time{};
  if (::clock_gettime(clock_, &time) == 0) usage.processor = std::chrono::seconds{time.tv_sec} + Duration{time.tv_nsec};
  return usage;
}

}  // namespace hirosco
