// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <mutex>
#include <shared_mutex>
#include <thread>

#include "hirosco/utilities/allocation_guard.hpp"

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming): what printf() and its like are with _FORTIFY_SOURCE
extern "C" int __printf_chk(int checks, const char* format, ...);
extern "C" int __fprintf_chk(std::FILE* file, int checks, const char* format, ...);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace hirosco {
namespace {

/// What a piece of code does of what real time forbids, but for the heap.
template <class Code>
RealtimeUses waits_of(Code code) {
  const RealtimeScope scope;
  code();
  RealtimeUses uses = scope.uses();
  uses.heap = 0;
  return uses;
}

constexpr RealtimeUses one_lock{.locks = 1};

TEST(BlockingHook, CountsEachKindOfLockWhetherItIsFreeOrNot) {
  std::mutex mutex;
  EXPECT_EQ(waits_of([&] { const std::lock_guard held{mutex}; }), one_lock);
  std::timed_mutex timed;
  EXPECT_EQ(waits_of([&] {
              pthread_mutex_t* const native = timed.native_handle();
              const timespec past{};
              EXPECT_EQ(::pthread_mutex_timedlock(native, &past), 0);
              timed.unlock();
            }),
            one_lock);
  std::shared_mutex shared;
  EXPECT_EQ(waits_of([&] { const std::shared_lock held{shared}; }), one_lock);
  EXPECT_EQ(waits_of([&] { const std::unique_lock held{shared}; }), one_lock);
  sem_t semaphore;
  ASSERT_EQ(::sem_init(&semaphore, 0, 1), 0);
  EXPECT_EQ(waits_of([&] { ::sem_wait(&semaphore); }), one_lock);
}

TEST(BlockingHook, DoesNotCountWhoOnlyTriesAndGivesBack) {
  std::mutex mutex;
  EXPECT_EQ(waits_of([&] {
              ASSERT_TRUE(mutex.try_lock());
              mutex.unlock();
            }),
            RealtimeUses{});
}

TEST(BlockingHook, CountsEachWayToPutOut) {
  std::FILE* const nowhere = std::fopen("/dev/null", "w");
  std::ofstream stream{"/dev/null"};
  ASSERT_NE(nowhere, nullptr);
  const int file = ::fileno(nowhere);
  char octet = 'x';
  const iovec part{&octet, 1};
  const int seven = std::getenv("PATH") != nullptr ? 7 : 8;  // so that no compiler makes another call of it
  const auto outputs = [&](auto code) { return waits_of(code).outputs; };
  EXPECT_GE(outputs([&] { (void)!::write(file, &octet, 1); }), 1U);
  EXPECT_GE(outputs([&] { (void)!::writev(file, &part, 1); }), 1U);
  EXPECT_GE(outputs([&] { (void)std::fwrite(&octet, 1, 1, nowhere); }), 1U);
  EXPECT_GE(outputs([&] { (void)std::fputs("words", nowhere); }), 1U);
  EXPECT_GE(outputs([&] { (void)std::fputc('x', nowhere); }), 1U);
  EXPECT_GE(outputs([&] { std::fprintf(nowhere, "%d", seven); }), 1U);
  EXPECT_GE(outputs([&] { std::printf("%d", seven); }), 1U);
  EXPECT_GE(outputs([&] { __fprintf_chk(nowhere, 1, "%d", seven); }), 1U);
  EXPECT_GE(outputs([&] { __printf_chk(1, "%d", seven); }), 1U);
  EXPECT_GE(outputs([&] { std::puts(""); }), 1U);
  EXPECT_GE(outputs([&] { fmt::print(nowhere, "{}", seven); }), 1U);
  EXPECT_GE(outputs([&] { std::cerr << seven; }), 1U);
  EXPECT_GE(outputs([&] { stream << seven << std::flush; }), 1U);
  std::fclose(nowhere);
}

TEST(BlockingHook, CountsNothingOutsideAScopeNorWhatAnotherThreadDoes) {
  const RealtimeScope scope;
  const RealtimeUses before = scope.uses();
  std::mutex mutex;
  {
    const HeapPermitted permitted;
    const std::lock_guard held{mutex};
    std::thread{[&] { std::fputs("\n", stdout); }}.join();
  }
  const RealtimeUses after = scope.uses();
  EXPECT_EQ(after.locks, before.locks);
  EXPECT_EQ(after.outputs, before.outputs);
}

TEST(BlockingHook, AScopeInAScopeCountsItsOwnAndTheOuterOneAll) {
  std::mutex mutex;
  const RealtimeScope outer;
  const std::lock_guard first{mutex};
  const RealtimeScope inner;
  std::fputs("\n", stdout);
  const RealtimeUses of_inner = inner.uses();
  const RealtimeUses of_outer = outer.uses();  // before GoogleTest locks and prints
  EXPECT_EQ(of_inner, (RealtimeUses{.outputs = 1}));
  EXPECT_EQ(of_outer.locks, 1U);
  EXPECT_EQ(of_outer.outputs, 1U);
}

}  // namespace
}  // namespace hirosco
