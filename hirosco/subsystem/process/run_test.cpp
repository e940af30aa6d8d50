// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/run.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/data_transfer/channel/socket_channel.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {
namespace {

/// The process that a supervisor of another build starts. Each test runs it in a child of its own.
struct BuiltApart : ::testing::Test {
  struct Idle final : Subsystem {};

  SealedMemory memory;
  MemoryHandle vital_memory = memory.create("vital", sizeof(VitalPage)).value();
  MemoryHandle permit_memory = memory.create("permit", sizeof(PermitPage)).value();
  Mapping vital = memory.map(vital_memory, Access::ReadWrite).value();
  Mapping permit = memory.map(permit_memory, Access::ReadWrite).value();
  PermitPage* page{nullptr};
  FileDescriptor supervisor, subsystem;

  void SetUp() override {
    GTEST_FLAG_SET(death_test_style, "fast");
    new (vital.octets.data()) VitalPage{};
    page = new (permit.octets.data()) PermitPage{};
    auto ends = SocketChannel::make_pair().value();
    supervisor = std::move(ends.first);
    subsystem = std::move(ends.second);
  }
  [[noreturn]] void run(
      const std::function<std::unique_ptr<Subsystem>()>& make = [] { return std::make_unique<Idle>(); },
      const std::vector<std::string>& more = {}) {
    const std::string file = ::testing::TempDir() + "built_apart.xml";
    std::ofstream{file} << testing::probe_descriptor;
    const auto number = [](int descriptor) { return std::to_string(descriptor); };
    std::vector<std::string> words{"started",
                                   "--descriptor",
                                   file,
                                   "--channel",
                                   number(subsystem.release()),
                                   "--vital",
                                   number(SealedMemory::descriptor(vital_memory)),
                                   "--permit",
                                   number(SealedMemory::descriptor(permit_memory))};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    std::_Exit(run_subsystem(static_cast<int>(arguments.size()), arguments.data(), make));
  }
};

TEST_F(BuiltApart, PagesOfAnotherVersionEndItWithAWordOfWhatToDo) {
  page->version = page_version + 1;
  EXPECT_EXIT(run(), ::testing::ExitedWithCode(3),
              "the supervisor's pages are of version " + std::to_string(page_version + 1) +
                  ", this program's of version " + std::to_string(page_version) + ": build both from one hirosco");
}

TEST_F(BuiltApart, AMessageOfAnotherVersionIsRefusedByNameOnce) {
  const std::array foreign{std::byte{1}, std::byte{envelope::version + 1},
                           std::byte{0}, std::byte{0},
                           std::byte{0}, std::byte{0},
                           std::byte{0}, std::byte{0}};
  for (int i = 0; i < 2; ++i)
    ASSERT_EQ(::send(supervisor.get(), foreign.data(), foreign.size(), 0), static_cast<ssize_t>(foreign.size()));
  supervisor.reset();  // it ends when it has read them
  EXPECT_EXIT(
      run(), ::testing::ExitedWithCode(0),
      "^started: the supervisor's control channel is of version 2, this program's of version 1: build both from "
      "one hirosco\n$");
}

TEST_F(BuiltApart, AWordThatItDoesNotKnowIsRefusedInOneLine) {
  const auto run_with = [&](const std::vector<std::string>& more) {
    run([] { return std::make_unique<Idle>(); }, more);
  };
  const std::string there_are =
      "; there are: --descriptor FILE, --channel FD, .*--subscribes NAME=ID:FILE "
      "\\(the supervisor passes them: hirosco run MISSION\\)\n$";
  EXPECT_EXIT(run_with({"--bogus", "X"}), ::testing::ExitedWithCode(2), "^started: no option '--bogus'" + there_are);
  EXPECT_EXIT(run_with({"--set"}), ::testing::ExitedWithCode(2),
              "^started: --set without its PARAMETER=VALUES" + there_are);
  EXPECT_EXIT(run_with({"--set", "GAIN=1", "2"}), ::testing::ExitedWithCode(2),
              "^started: '2' belongs to no option" + there_are);
}

TEST_F(BuiltApart, EveryWordByWhichASupervisorChangesADescriptorIsKnown) {
  for (const std::string& word : std::vector<std::string>{"--as", "--set", "--address", "--enable", "--power",
                                                          "--fall-back", "--setting", "--commands", "--subscribes"})
    EXPECT_EXIT(run([] { return std::make_unique<Idle>(); }, {word, "?"}), ::testing::ExitedWithCode(3),
                "^started: " + word + " \\?: ");
}

/// Counts how often its work is called while its descriptor has something, and while it has nothing.
class Waiting final : public Subsystem {
 public:
  explicit Waiting(int calls) : calls_left_{calls} {}
  static constexpr int good = 7;
  static constexpr int bad = 8;

 protected:
  ServiceWake service_wake() const override { return {.descriptor = event_.descriptor()}; }

 private:
  /// After so many calls beside a descriptor that is readable all the time: how long they took at least.
  void service(TimePoint now) override {
    if (!began_) {
      began_ = now;
      event_.notify();
    }
    if (--calls_left_ >= 0) return;
    // Two more than the pauses between them: the first call, and the one after the supervisor had let go.
    std::_Exit(now - *began_ >= 1ms * (first_calls_ - 2) ? good : bad);
  }
  int calls_left_;
  int first_calls_{calls_left_};
  std::optional<TimePoint> began_;
  WakeEvent event_{WakeEvent::create().value()};
};

using ServiceWakeTest = BuiltApart;

TEST_F(ServiceWakeTest, WhoLeavesItsDescriptorReadableIsCalledNoMoreThanOnceInAMillisecond) {
  EXPECT_EXIT(run([] { return std::make_unique<Waiting>(25); }), ::testing::ExitedWithCode(Waiting::good), "");
}

/// Calls in a span with something in its descriptor, and in one as long with nothing.
class Compared final : public Subsystem {
 protected:
  ServiceWake service_wake() const override { return {.descriptor = event_.descriptor()}; }

 private:
  void service(TimePoint now) override {
    if (!until_) {
      until_ = now + 100ms;
      event_.notify();
    }
    ++calls_[heard_ ? 1 : 0];
    if (now < *until_) return;
    if (heard_) std::_Exit(calls_[0] > 3 * calls_[1] ? Waiting::good : Waiting::bad);
    heard_ = true;
    event_.clear();
    until_ = now + 100ms;
  }
  bool heard_{false};
  std::array<int, 2> calls_{};
  std::optional<TimePoint> until_;
  WakeEvent event_{WakeEvent::create().value()};
};

TEST_F(ServiceWakeTest, WhatItsDescriptorBringsIsNotLeftUntilThePaceIsOver) {
  EXPECT_EXIT(run([] { return std::make_unique<Compared>(); }), ::testing::ExitedWithCode(Waiting::good), "");
}

}  // namespace
}  // namespace hirosco
