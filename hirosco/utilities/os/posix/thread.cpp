// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/thread.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <ctime>
#include <utility>

namespace hirosco {
namespace {

struct Start {
  std::string name;
  std::function<void()> body;
};

void* run(void* argument) noexcept {
  const std::unique_ptr<Start> start{static_cast<Start*>(argument)};
  set_thread_name(start->name.c_str());
  start->body();
  return nullptr;
}

}  // namespace

Result<Thread> Thread::begin(std::string name, std::function<void()> body, std::size_t stack_octets) {
  auto start = std::make_unique<Start>(Start{std::move(name), std::move(body)});
  pthread_attr_t attributes;
  if (const int error = pthread_attr_init(&attributes); error != 0)
    return fail(ErrorCode::SystemFailure, "thread attributes", error);
  int error = 0;
  if (stack_octets != 0)
    error = pthread_attr_setstacksize(&attributes, std::max(stack_octets, static_cast<std::size_t>(PTHREAD_STACK_MIN)));
  Thread thread;
  if (error == 0)
    error = pthread_create(&thread.handle_, &attributes, [](void* a) -> void* { return run(a); }, start.get());
  (void)pthread_attr_destroy(&attributes);
  if (error != 0) return fail(ErrorCode::SystemFailure, "start thread", error);
  (void)start.release();
  thread.joinable_ = true;
  return thread;
}

Thread::Thread(Thread&& other) noexcept : handle_{other.handle_}, joinable_{std::exchange(other.joinable_, false)} {}

Thread& Thread::operator=(Thread&& other) noexcept {
  if (this == &other) return *this;
  join();
  handle_ = other.handle_;
  joinable_ = std::exchange(other.joinable_, false);
  return *this;
}

void Thread::join() noexcept {
  if (std::exchange(joinable_, false)) (void)pthread_join(handle_, nullptr);
}

void Thread::leave_behind() noexcept {
  if (std::exchange(joinable_, false)) (void)pthread_detach(handle_);
}

void sleep_until(TimePoint wake) noexcept {
  const Duration since_start = std::max(wake.time_since_epoch(), Duration{0});
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(since_start);
  const timespec limit{static_cast<time_t>(whole.count()), static_cast<long>((since_start - whole).count())};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &limit, nullptr) == EINTR) {}
}

Result<> lock_memory() noexcept {
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) return fail(ErrorCode::SystemFailure, "lock memory", errno);
  return ok();
}

}  // namespace hirosco
