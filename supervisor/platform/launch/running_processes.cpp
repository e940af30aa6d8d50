// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/running_processes.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include "hirosco/utilities/os/clock.hpp"

namespace hirosco::supervisor {
namespace {

/// How long one that cannot be gone on with may take to go before it is told as one that hangs.
constexpr int longest_end_ms = 50;

[[nodiscard]] FileDescriptor open_statm(const std::string& process) {
  return FileDescriptor{::open(("/proc/" + process + "/statm").c_str(), O_RDONLY | O_CLOEXEC)};
}

}  // namespace

std::uint32_t RunningProcesses::add(Process process) {
  const std::uint32_t number = next_++;
  memory_use_[number] = open_statm(std::to_string(process.pid()));
  if (!memory_use_[0]) memory_use_[0] = open_statm("self");
  if (auto meter = ProcessMeter::of(process.pid())) meters_.emplace(number, std::move(*meter));
  processes_.emplace(number, std::move(process));
  return number;
}

std::uint32_t RunningProcesses::end_now(Process process) {
  process.kill_with_its_own();
  pollfd look{process.handle().get(), POLLIN, 0};
  static_cast<void>(::poll(&look, 1, longest_end_ms));
  if (const auto end = process.poll(); end && *end) return 0;
  const std::uint32_t number = next_++;
  processes_.emplace(number, std::move(process));
  return number;
}

const Process* RunningProcesses::find(std::uint32_t number) const {
  const auto found = processes_.find(number);
  return found != processes_.end() ? &found->second : nullptr;
}

std::optional<ProcessEnd> RunningProcesses::ended(std::uint32_t number) {
  const auto found = processes_.find(number);
  if (found == processes_.end()) return ProcessEnd{};
  const auto status = found->second.poll();
  if (!status || !*status) return std::nullopt;
  ProcessEnd end{(*status)->kind == ExitStatus::Kind::Signalled, (*status)->value};
  if ((*status)->kind == ExitStatus::Kind::Unknown) {
    // Its parent was a supervisor that is gone: the keeper is told, a moment later.
    constexpr std::uint32_t not_told = 0xFFFF'FFFF;
    const auto pid = static_cast<std::uint32_t>(found->second.pid());
    const std::uint32_t how = page_ != nullptr ? page_->end_of(pid).value_or(not_told) : not_told;
    constexpr Duration longest = 300ms;
    const TimePoint now = SystemClock{}.now();
    const bool told = how != not_told;
    if (!told && page_ != nullptr && now - end_asked_.emplace(number, now).first->second < longest) return std::nullopt;
    end_asked_.erase(number);
    if (told) end = {(how & ended_by_signal) != 0, static_cast<int>(how & 0xFF)};
  }
  found->second.kill_with_its_own();  // whoever it has left behind holds its devices
  processes_.erase(found);
  memory_use_.erase(number);
  meters_.erase(number);
  return end;
}

void RunningProcesses::kill(std::uint32_t number) {
  if (const auto found = processes_.find(number); found != processes_.end()) found->second.kill_with_its_own();
}

void RunningProcesses::kill_all() {
  for (auto& [number, process] : processes_) process.kill_with_its_own();
}

bool RunningProcesses::any() {
  for (auto entry = processes_.begin(); entry != processes_.end();) {
    const auto status = entry->second.poll();
    entry = !status || status->has_value() ? processes_.erase(entry) : std::next(entry);
  }
  return !processes_.empty();
}

std::optional<ProcessUsage> RunningProcesses::usage(std::uint32_t number) noexcept {
  const auto found = meters_.find(number);
  return found != meters_.end() ? found->second.look() : std::nullopt;
}

std::uint32_t RunningProcesses::resident_kb(std::uint32_t number) const noexcept {
  const auto found = memory_use_.find(number);
  if (found == memory_use_.end()) return 0;
  std::array<char, 128> text;
  const auto octets = ::pread(found->second.get(), text.data(), text.size(), 0);
  if (octets <= 0) return 0;
  // "size resident shared ...", in pages.
  const std::string_view line{text.data(), static_cast<std::size_t>(octets)};
  const auto blank = line.find(' ');
  std::uint64_t pages = 0;
  if (blank != std::string_view::npos) std::from_chars(line.data() + blank + 1, line.data() + line.size(), pages);
  static const auto page_octets = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return static_cast<std::uint32_t>(pages * page_octets / 1024);
}

}  // namespace hirosco::supervisor
