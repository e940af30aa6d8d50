// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/last_words.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <functional>
#include <new>
#include <stdexcept>
#include <system_error>

#include <gtest/gtest.h>

#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

template <class E>
void raise(const E& exception) {
  throw exception;
}

/// Where nothing catches: as in a cycle, or at the end of a thread.
void uncaught(const std::function<void()>& body) noexcept { body(); }

template <class E>
void speak(const E& exception) {
  say_last_words("hirosco-probe");
  uncaught([&] { raise(exception); });
}

TEST(LastWords, NameTheProgramAndWhatItLackedAndItExitsAsForAnEnvironmentThatRefuses) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(speak(std::bad_alloc{}), ::testing::ExitedWithCode(3), "hirosco-probe: no memory left");
  EXPECT_EXIT(speak(std::system_error{EAGAIN, std::generic_category(), "thread"}), ::testing::ExitedWithCode(3),
              "hirosco-probe: the system refuses what is needed .*thread: Resource temporarily unavailable");
}

TEST(LastWords, OfAnotherThreadAreSaidToo) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto in_a_thread = [] {
    say_last_words("hirosco-probe");
    auto thread = Thread::start("lacking", [] { raise(std::bad_alloc{}); });
    thread->join();
  };
  EXPECT_EXIT(in_a_thread(), ::testing::ExitedWithCode(3), "hirosco-probe: no memory left");
}

TEST(LastWords, ThatNobodyReadsKeepNobodyAlive) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto unheard = [] {
    std::array<int, 2> ends{-1, -1};
    if (::pipe(ends.data()) != 0) return;
    static_cast<void>(::fcntl(ends[1], F_SETFL, O_NONBLOCK));
    while (::write(ends[1], "#", 1) == 1) {}
    static_cast<void>(::fcntl(ends[1], F_SETFL, 0));
    static_cast<void>(::dup2(ends[1], STDERR_FILENO));
    ::alarm(20);
    speak(std::bad_alloc{});
  };
  EXPECT_EXIT(unheard(), ::testing::ExitedWithCode(3), "");
}

TEST(LastWords, OfADefectNameItAndAbort) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(speak(std::logic_error{"two of one"}), ::testing::KilledBySignal(SIGABRT),
              "hirosco-probe: a defect: two of one");
}

}  // namespace
}  // namespace hirosco
