// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/running_processes.hpp"

#include <poll.h>
#include <signal.h>

#include <iterator>
#include <utility>

#include "hirosco/utilities/os/clock.hpp"

namespace hirosco::supervisor {
namespace {

/// How long one that cannot be gone on with may take to go before it is told as one that hangs.
constexpr int longest_end_ms = 50;

}  // namespace

std::uint32_t RunningProcesses::add(Process process, FileDescriptor handle, std::shared_ptr<ProcessGrip> grip) {
  const std::uint32_t number = next_++;
  watch_.add(number, process.pid(), std::move(handle), std::move(grip));
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
  watch_.remove(number);
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

std::uint32_t RunningProcesses::resident_kb(std::uint32_t number) noexcept {
  if (number != 0) return watch_.usage(number).value_or(ProcessUsage{}).resident_kb;
  const auto own = own_ ? own_->look() : std::nullopt;
  return own ? own->resident_kb : 0;
}

}  // namespace hirosco::supervisor
