// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/running_processes.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <utility>

/// Of real processes: what is known of them until they were seen to end. How those end whose parent is gone is tried with a keeper, in
/// system_launcher_test.cpp.
namespace hirosco::supervisor {
namespace {

/// A process that rests until it is killed.
Process resting() {
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (;;) ::pause();
  }
  return Process::adopt(child).value();
}

/// One that ends by itself, and has.
Process ended_with(int code) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(code);
  Process process = Process::adopt(child).value();
  pollfd look{process.handle().get(), POLLIN, 0};
  static_cast<void>(::poll(&look, 1, -1));
  return process;
}

std::uint32_t add(RunningProcesses& running, Process process) {
  FileDescriptor handle{::fcntl(process.handle().get(), F_DUPFD_CLOEXEC, 0)};
  return running.add(std::move(process), std::move(handle), nullptr);
}

/// When it has gone.
std::optional<ProcessEnd> end_of(RunningProcesses& running, std::uint32_t number) {
  pollfd look{running.find(number)->handle().get(), POLLIN, 0};
  static_cast<void>(::poll(&look, 1, -1));
  return running.ended(number);
}

TEST(RunningProcesses, AreKnownUntilTheyWereSeenToEndAndNoNumberComesTwice) {
  RunningProcesses running;
  const std::uint32_t one = add(running, ended_with(3));
  const auto end = running.ended(one);
  ASSERT_TRUE(end);
  EXPECT_FALSE(end->by_signal);
  EXPECT_EQ(end->value, 3);
  EXPECT_EQ(running.find(one), nullptr);
  EXPECT_TRUE(running.ended(one)) << "who is not known has ended";
  const std::uint32_t other = add(running, resting());
  EXPECT_NE(other, one);
  EXPECT_FALSE(running.ended(other));
  running.kill(other);
  const auto killed = end_of(running, other);
  ASSERT_TRUE(killed);
  EXPECT_TRUE(killed->by_signal);
  EXPECT_EQ(killed->value, SIGKILL);
}

TEST(RunningProcesses, WhatTheyTakeIsToldUntilTheyHaveEnded) {
  RunningProcesses running;
  const std::uint32_t number = add(running, resting());
  while (running.resident_kb(number) == 0) ::sched_yield();
  EXPECT_GT(running.resident_kb(0), 0U) << "we ourselves";
  EXPECT_TRUE(running.watch().usage(number));
  running.kill(number);
  static_cast<void>(end_of(running, number));
  EXPECT_EQ(running.resident_kb(number), 0U);
  EXPECT_FALSE(running.watch().usage(number));
}

TEST(RunningProcesses, WhoIsEndedAtOnceAndGoesIsNoneOfThem) {
  RunningProcesses running;
  // Where this computer is busy it may take longer to go: then it is seen to its end.
  if (const std::uint32_t late = running.end_now(resting()); late != 0) {
    EXPECT_TRUE(end_of(running, late));
  }
  EXPECT_FALSE(running.any());
}

TEST(RunningProcesses, WhoEndsByItselfTakesAlongWhomItHasLeftBehind) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  const FileDescriptor read_end{ends[0]};
  FileDescriptor write_end{ends[1]};
  auto process = Process::spawn({.executable = "/bin/sh",
                                 .arguments = {"-c", "sleep 1000 & echo"},
                                 .inherited = {{write_end.get(), STDOUT_FILENO}}});
  ASSERT_TRUE(process) << process.error().text;
  write_end.reset();
  const pid_t group = process->pid();
  // PIDFD_SIGNAL_PROCESS_GROUP: without it nobody is sure whose the number of an ended one is.
  const bool told = ::syscall(SYS_pidfd_send_signal, process->handle().get(), 0, nullptr, 1U << 2) == 0;
  char octet = 0;
  ASSERT_EQ(::read(read_end.get(), &octet, 1), 1);
  RunningProcesses running;
  const auto end = end_of(running, add(running, std::move(*process)));
  ASSERT_TRUE(end);
  EXPECT_FALSE(end->by_signal);
  if (!told) ::kill(-group, SIGKILL);
  EXPECT_EQ(::read(read_end.get(), &octet, 1), 0) << "nobody holds it open any more";
}

TEST(RunningProcesses, AreAllKilledTogether) {
  RunningProcesses running;
  const std::uint32_t one = add(running, resting()), other = add(running, resting());
  EXPECT_TRUE(running.any());
  running.kill_all();
  EXPECT_TRUE(end_of(running, one));
  EXPECT_TRUE(end_of(running, other));
  EXPECT_FALSE(running.any());
}

}  // namespace
}  // namespace hirosco::supervisor
