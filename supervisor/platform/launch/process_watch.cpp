// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/process_watch.hpp"

#include <poll.h>
#include <signal.h>
#include <time.h>

#include <utility>

namespace hirosco::supervisor {
namespace {

constexpr std::size_t stack_octets = std::size_t{256} * 1024;

[[nodiscard]] bool has_ended(const FileDescriptor& handle) noexcept {
  pollfd end{handle.get(), POLLIN, 0};
  return ::poll(&end, 1, 0) != 0;
}

}  // namespace

ProcessWatch::ProcessWatch() {
  if (auto thread = Thread::start("process watch", [this] { run(); }, stack_octets)) thread_ = std::move(*thread);
}

ProcessWatch::~ProcessWatch() {
  ending_.store(true);
  asked_.post();
}

void ProcessWatch::add(std::uint32_t number, int pid, FileDescriptor handle, std::shared_ptr<ProcessGrip> grip) {
  auto watched = std::make_shared<Watched>();
  watched->pid = pid;
  watched->handle = std::move(handle);
  watched->grip = std::move(grip);
  if (::clock_getcpuclockid(pid, &watched->clock) != 0) return;  // it has ended
  const LockGuard lock{mutex_};
  ask(*watched_.insert_or_assign(number, std::move(watched)).first->second);
}

void ProcessWatch::remove(std::uint32_t number) {
  std::shared_ptr<Watched> gone;  // its descriptors are closed behind the lock
  const LockGuard lock{mutex_};
  const auto found = watched_.find(number);
  if (found == watched_.end()) return;
  gone = std::move(found->second);
  watched_.erase(found);
}

std::optional<ProcessUsage> ProcessWatch::usage(std::uint32_t number) noexcept {
  const LockGuard lock{mutex_};
  const auto found = watched_.find(number);
  if (found == watched_.end() || has_ended(found->second->handle)) return std::nullopt;
  Watched& watched = *found->second;
  ask(watched);
  ProcessUsage usage = watched.usage;
  timespec time{};
  if (::clock_gettime(watched.clock, &time) != 0) return std::nullopt;
  usage.processor = std::chrono::seconds{time.tv_sec} + Duration{time.tv_nsec};
  return usage;
}

std::optional<StrayThread> ProcessWatch::stray(std::uint32_t number, const ThreadPlaces& places) noexcept {
  const LockGuard lock{mutex_};
  const auto found = watched_.find(number);
  if (found == watched_.end()) return std::nullopt;
  Watched& watched = *found->second;
  if (watched.places != places) watched.stray.reset();
  watched.places = places;
  ask(watched);
  return watched.stray;
}

void ProcessWatch::ask(Watched& watched) noexcept {
  if (!std::exchange(watched.asked, true)) asked_.post();
}

void ProcessWatch::run() {
  sigset_t all;
  sigfillset(&all);
  static_cast<void>(::pthread_sigmask(SIG_SETMASK, &all, nullptr));
  static_cast<void>(set_background_scheduling());
  for (;;) {
    asked_.wait();
    if (ending_.load()) return;
    // Of whom it was asked may be gone by now.
    if (const auto watched = next()) look(*watched);
  }
}

std::shared_ptr<ProcessWatch::Watched> ProcessWatch::next() {
  const LockGuard lock{mutex_};
  auto entry = watched_.upper_bound(turn_);
  for (std::size_t i = 0; i < watched_.size(); ++i, ++entry) {
    if (entry == watched_.end()) entry = watched_.begin();
    if (!std::exchange(entry->second->asked, false)) continue;
    turn_ = entry->first;
    return entry->second;
  }
  return nullptr;
}

void ProcessWatch::look(Watched& watched) {
  std::optional<ThreadPlaces> places;
  {
    const LockGuard lock{mutex_};
    places = watched.places;
  }
  if (!watched.meter)
    if (auto meter = ProcessMeter::of(watched.pid)) watched.meter = std::move(*meter);
  const auto usage = watched.meter ? watched.meter->look() : std::nullopt;
  const auto stray = places ? stray_thread(watched.pid, *places) : std::nullopt;
  if (watched.grip) watched.grip->find_threads();
  const LockGuard lock{mutex_};
  // Whose number it was when it was looked at nobody else has as long as it has not ended.
  if (!usage || has_ended(watched.handle)) return;
  const std::uint32_t looks = watched.usage.look;
  watched.usage = *usage;
  watched.usage.look = looks + 1;
  if (watched.places == places) watched.stray = stray;
}

}  // namespace hirosco::supervisor
