// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/process_usage.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <limits>
#include <string>

#include "hirosco/utilities/os/semaphore.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

TEST(ProcessStatus, GivesTheNumberBehindAName) {
  constexpr std::string_view status = "Name:\tVmData: 3\nVmData:\t    1234 kB\nThreads:\t7\n";
  EXPECT_EQ(number_in_status(status, "VmData"), 1234U);
  EXPECT_EQ(number_in_status(status, "Threads"), 7U);
  EXPECT_EQ(number_in_status(status, "Thread"), 0U);
  EXPECT_EQ(number_in_status(status, "Name"), 0U);
  EXPECT_EQ(number_in_status("VmData:", "VmData"), 0U);
  EXPECT_EQ(number_in_status("VmData:\t21474836480 kB", "VmData"), std::numeric_limits<std::uint32_t>::max());
}

TEST(ProcessMeter, SeesMemoryThreadsAndDescriptorsThatWeTake) {
  auto meter = ProcessMeter::own().value();
  const ProcessUsage before = meter.look().value();
  EXPECT_GT(before.memory_kb, 0U);
  constexpr std::size_t octets = std::size_t{32} << 20;
  void* const taken = ::mmap(nullptr, octets, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(taken, MAP_FAILED);
  const FileDescriptor one{::dup(0)}, another{::dup(0)};
  Semaphore end{0};
  auto thread = Thread::start("idle", [&] { end.wait(); }).value();
  const ProcessUsage after = meter.look().value();
  end.post();
  ::munmap(taken, octets);
  // Sanitizers map more than can be counted.
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  EXPECT_GE(after.memory_kb, std::min<std::uint64_t>(most, std::uint64_t{before.memory_kb} + octets / 1024));
  EXPECT_EQ(after.threads, before.threads + 1);
  EXPECT_EQ(after.descriptors, before.descriptors == 0 ? 0 : before.descriptors + 2) << "or they cannot be counted";
  EXPECT_GE(after.processor, before.processor);
}

/// Forks where it is told to, and waits for what it forked; its end takes that with it.
TEST(ProcessMeter, CountsTheProcessesThatAnotherHasStartedWhicheverOfItsThreadsDidIt) {
  std::array<int, 2> order{}, done{};
  ASSERT_EQ(::pipe(order.data()), 0);
  ASSERT_EQ(::pipe(done.data()), 0);
  const pid_t parent = ::fork();
  if (parent == 0) {
    ::setpgid(0, 0);
    char octet = 0;
    if (::read(order[0], &octet, 1) != 1) ::_exit(1);
    const auto start = [] {
      if (::fork() == 0)
        for (;;) ::pause();
    };
    start();
    auto another = Thread::start("forks", [&] {
      start();
      (void)!::write(done[1], &octet, 1);
      for (;;) ::pause();
    });
    for (;;) ::pause();
  }
  auto meter = ProcessMeter::of(parent).value();
  EXPECT_EQ(meter.look().value().processes, 1U);
  char octet = 'x';
  ASSERT_EQ(::write(order[1], &octet, 1), 1);
  ASSERT_EQ(::read(done[0], &octet, 1), 1);
  const bool told = ::access("/proc/self/task", R_OK) == 0 &&
                    ::access(("/proc/self/task/" + std::to_string(::getpid()) + "/children").c_str(), R_OK) == 0;
  EXPECT_EQ(meter.look().value().processes, told ? 3U : 1U) << "or the system does not tell";
  ::kill(-parent, SIGKILL);
  int status = 0;
  ::waitpid(parent, &status, 0);
  for (const int end : {order[0], order[1], done[0], done[1]}) ::close(end);
}

/// As a shim leaves it that began a process, did not wait for it and gave its place to an interpreter, which knows nothing of it.
TEST(ProcessMeter, DoesNotCountWhoHasEndedAndWasNotWaitedFor) {
  std::array<int, 2> done{};
  ASSERT_EQ(::pipe(done.data()), 0);
  const pid_t parent = ::fork();
  if (parent == 0) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    siginfo_t info{};
    ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT);
    (void)!::write(done[1], "x", 1);
    for (;;) ::pause();
  }
  char octet = 0;
  ASSERT_EQ(::read(done[0], &octet, 1), 1);
  EXPECT_EQ(ProcessMeter::of(parent).value().look().value().processes, 1U);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  for (const int end : done) ::close(end);
}

TEST(ProcessMeter, OfAnotherSaysWhenThatHasEnded) {
  const pid_t child = ::fork();
  if (child == 0)
    for (;;) ::pause();
  auto meter = ProcessMeter::of(child).value();
  EXPECT_EQ(meter.look().value().threads, 1U);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_FALSE(meter.look());
  EXPECT_FALSE(ProcessMeter::of(child));
}

}  // namespace
}  // namespace hirosco
