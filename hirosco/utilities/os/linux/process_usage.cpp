// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/process_usage.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <limits>
#include <span>
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
[[nodiscard]] std::uint32_t children_of(const ProcessThreads& threads, int thread, std::uint32_t most) noexcept {
  const FileDescriptor children = threads.open(thread, "children");
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

[[nodiscard]] std::uint32_t children_of_all(ProcessThreads& threads) noexcept {
  std::uint32_t count = 0;
  threads.each([&](int thread) {
    if (count < most_children) count += children_of(threads, thread, most_children - count);
  });
  return count;
}

[[nodiscard]] Result<FileDescriptor> open_status(const char* path) noexcept {
  FileDescriptor status{::open(path, O_RDONLY | O_CLOEXEC)};
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

Result<ProcessMeter> ProcessMeter::own() noexcept {
  HIROSCO_TRY_LET(FileDescriptor status, open_status("/proc/self/status"));
  return ProcessMeter{std::move(status), {}, Whose::Own, CLOCK_PROCESS_CPUTIME_ID};
}

Result<ProcessMeter> ProcessMeter::of(int pid) noexcept {
  std::array<char, 40> path{};
  std::snprintf(path.data(), path.size(), "/proc/%d/status", pid);
  HIROSCO_TRY_LET(FileDescriptor status, open_status(path.data()));
  clockid_t clock{};
  if (const int error = ::clock_getcpuclockid(pid, &clock); error != 0)
    return fail(ErrorCode::NotFound, "processor time of a process", error);
  return ProcessMeter{std::move(status), ProcessThreads::of(pid), Whose::Others, clock};
}

std::optional<ProcessUsage> ProcessMeter::look() noexcept {
  std::array<char, 4096> text;
  const auto octets = ::pread(status_.get(), text.data(), text.size(), 0);
  if (octets <= 0) return std::nullopt;
  const std::string_view status{text.data(), static_cast<std::size_t>(octets)};
  ProcessUsage usage;
  const std::uint32_t data_kb = number_in_status(status, "VmData");
  usage.memory_kb = data_kb + std::min(number_in_status(status, "VmStk"), most_counted - data_kb);
  usage.resident_kb = number_in_status(status, "VmRSS");
  usage.shared_memory_kb = number_in_status(status, "RssShmem");
  usage.threads = number_in_status(status, "Threads");
  if (whose_ == Whose::Own) usage.descriptors = own_descriptors();
  else usage.processes = 1 + children_of_all(threads_);
  timespec time{};
  if (::clock_gettime(clock_, &time) == 0) usage.processor = std::chrono::seconds{time.tv_sec} + Duration{time.tv_nsec};
  return usage;
}

}  // namespace hirosco
