// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/guard_shell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// The guard's thread and its two ways in. Time stands still unless the test moves it; the thread runs all the same.
namespace hirosco::supervisor {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::IsEmpty;
using namespace std::chrono_literals;

/// Counts how often it is asked, which the guard's thread does at least three times in each of its rounds.
class HandClock final : public Clock {
 public:
  void advance(Duration span) noexcept { since_begin_ += span.count(); }
  [[nodiscard]] int asked() const noexcept { return asked_; }

 private:
  [[nodiscard]] TimePoint do_now() const noexcept override {
    ++asked_;
    return TimePoint{10s} + Duration{since_begin_.load()};
  }
  [[nodiscard]] OnboardTime do_onboard() const noexcept override { return {}; }
  std::atomic<Duration::rep> since_begin_{0};
  mutable std::atomic<int> asked_{0};
};

/// A device that answers each command at once in the thread that asks it, while it is not mute.
class OneDevice final : public FlowFactory {
 public:
  std::atomic<bool> mute{false};
  std::atomic<bool> acts{false};  ///< it says so; else that it holds

 private:
  struct Line final : DataFlow {
    explicit Line(const OneDevice& of_it) : device{of_it} {}
    [[nodiscard]] Result<> do_send(Octets frame) noexcept override {
      if (const auto command = read_enable_command(frame)) answer = command->sequence;
      return ok();
    }
    [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override {
      if (device.mute || !answer) return Received{};
      const auto output = device.acts ? DeviceOutput::Active : DeviceOutput::Holding;
      HIROSCO_TRY_LET(const Octets written,
                      write_enable_status(buffer, {.output = output, .flags = 0, .epoch = 0, .sequence = *answer}));
      answer.reset();
      return Received{Flow::New, written.size()};
    }
    [[nodiscard]] bool do_wait(Duration) noexcept override { return false; }
    const OneDevice& device;
    std::optional<std::uint32_t> answer;
  };
  [[nodiscard]] Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress&, FlowSide) override {
    return std::make_unique<Line>(*this);
  }
};

/// Whose end lets the device speak.
struct EndedProcess final : ProcessGrip {
  explicit EndedProcess(std::atomic<bool>& device_is_mute) : mute{device_is_mute} {}
  void take_realtime() noexcept override {}
  void take_loops_realtime() noexcept override {}
  void give_realtime() noexcept override {}
  LoopTime loop_time() noexcept override { return {}; }
  Duration processor_time() noexcept override { return {}; }
  void kill() noexcept override { mute = false; }
  std::atomic<bool>& mute;
};

/// ARM may move, and its MOTOR can be asked; HAND rests and answers for itself; CAMERA is spared.
struct GuardShellTest : ::testing::Test {
  HandClock clock;
  OneDevice device;
  HeapMemory memory;
  TestFolder folder;
  descriptor::Mission mission = [] {
    auto made = testing::small_mission();
    auto& motor = made.subsystems[0].subsystem.devices.emplace_back();
    motor.name = "MOTOR";
    motor.actuator = true;
    motor.stop_within = 200ms;
    motor.enable = descriptor::Endnode{};
    return made;
  }();
  Guard guard{{.clock = clock, .flows = device, .first_epoch = 1000, .on_finding = {}}};
  LaunchedSubsystem arm;
  std::unique_ptr<GuardShell> shell;

  void SetUp() override {
    // It stays so: whatever a failing test leaves behind is not to end all of them.
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGUSR1);
    ASSERT_EQ(::pthread_sigmask(SIG_BLOCK, &set, nullptr), 0);
    for (const auto& described : mission.subsystems)
      ASSERT_TRUE(guard.add(described, described.subsystem.id == testing::camera));
    const auto page = [&](std::size_t octets) {
      return memory.map(memory.create("page", octets).value(), Access::ReadWrite).value();
    };
    arm.vital = page(sizeof(VitalPage));
    arm.permit = page(sizeof(PermitPage));
    arm.grip = std::make_shared<EndedProcess>(device.mute);
    new (arm.vital.octets.data()) VitalPage{};
    new (arm.permit.octets.data()) PermitPage{};
    guard.started(testing::arm, arm);
    ASSERT_TRUE(guard.release(testing::arm, guard.fences(testing::arm)));
  }
  [[nodiscard]] VitalPage& vital() { return *reinterpret_cast<VitalPage*>(arm.vital.octets.data()); }
  [[nodiscard]] bool arm_may_move() {
    const auto& page = *reinterpret_cast<const PermitPage*>(arm.permit.octets.data());
    return page.permits(page.epoch.load());
  }
  void start(GuardShell::Calls calls = {}) {
    auto started = GuardShell::start(guard, clock, folder.path(), std::move(calls));
    ASSERT_TRUE(started) << started.error().text;
    shell = std::move(*started);
  }
  /// What is waited for ends the wait.
  static void until(auto&& condition) {
    while (!condition()) ::usleep(100);
  }
  /// The thread has begun and ended a round since.
  void a_round() {
    until([this, most = clock.asked() + 20] { return clock.asked() >= most; });
  }
  void pass(Duration span) {
    clock.advance(span);
    a_round();
  }
  [[nodiscard]] FileDescriptor connect() {
    FileDescriptor client{::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)};
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, (folder.path() / "safe.socket").c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return client;
  }
  static void ask(const FileDescriptor& client, std::string_view words) {
    ASSERT_EQ(::send(client.get(), words.data(), words.size(), MSG_NOSIGNAL), static_cast<ssize_t>(words.size()));
  }
  /// All that is said until it is let go.
  [[nodiscard]] static std::vector<std::string> lines(const FileDescriptor& client) {
    std::vector<std::string> all;
    std::array<char, 256> line{};
    for (;;) {
      const auto octets = ::recv(client.get(), line.data(), line.size(), 0);
      if (octets <= 0) return all;
      all.emplace_back(line.data(), static_cast<std::size_t>(octets));
    }
  }
  /// Nothing was said, and it was not let go.
  [[nodiscard]] static bool is_waited_for(const FileDescriptor& client) {
    pollfd look{client.get(), POLLIN, 0};
    return ::poll(&look, 1, 0) == 0;
  }
  [[nodiscard]] std::vector<GuardFinding::Kind> kinds() {
    std::vector<GuardFinding::Kind> found;
    for (const auto& finding : guard.take_findings()) found.push_back(finding.kind);
    return found;
  }
};

TEST_F(GuardShellTest, WhoAsksForSafeStopsEverythingAndIsToldOfEverybodyWhoWasToStop) {
  start();
  ASSERT_TRUE(arm_may_move());
  const FileDescriptor client = connect();
  ask(client, "SAFE");
  EXPECT_THAT(lines(client),
              ElementsAre("STOPPED MOTOR stopped 0 ms, says the device\n", "STOPPED HAND stopped 0 ms\n", "END 1 2\n"));
  EXPECT_FALSE(arm_may_move());
  EXPECT_THAT(kinds(), ElementsAre(GuardFinding::Kind::StopAsked));
}

TEST_F(GuardShellTest, TheAnswerComesWhenTheLastHasStoppedAndSaysAfterHowLong) {
  device.mute = true;
  start();
  const FileDescriptor client = connect();
  ask(client, "SAFE");
  until([this] { return !arm_may_move(); });
  a_round();
  pass(40ms);
  EXPECT_TRUE(is_waited_for(client));
  device.mute = false;
  EXPECT_THAT(lines(client), ElementsAre("STOPPED MOTOR stopped 40 ms, says the device\n",
                                         "STOPPED HAND stopped 0 ms\n", "END 1 2\n"));
}

TEST_F(GuardShellTest, WhatRestsOtherwiseThanItsDescriptorDeclaresIsToldWithItsStop) {
  device.acts = true;
  start();
  for (int step = 0; step < 4; ++step) pass(Guard::period);
  const FileDescriptor client = connect();
  ask(client, "SAFE");
  until([this] { return !arm_may_move(); });
  device.acts = false;
  EXPECT_THAT(lines(client),
              ElementsAre("STOPPED MOTOR stopped 0 ms, says the device, but it holds, and its descriptor "
                          "declares that it lets go\n",
                          "STOPPED HAND stopped 0 ms\n", "END 1 2\n"));
}

TEST_F(GuardShellTest, WhoDidNotConfirmThatItStoppedIsNamed) {
  device.mute = true;
  start();
  const FileDescriptor client = connect();
  ask(client, "SAFE");
  until([this] { return !arm_may_move(); });
  a_round();
  while (is_waited_for(client)) pass(Guard::most_unwatched);
  EXPECT_THAT(lines(client), ElementsAre("UNCONFIRMED MOTOR did not confirm that it stopped\n",
                                         "STOPPED HAND stopped 0 ms\n", "END 1 2\n"));
}

TEST_F(GuardShellTest, WhoseSubsystemHadToBeEndedForItIsNamed) {
  device.mute = true;
  vital().state = static_cast<std::uint32_t>(State::Operational);
  vital().cycling = 1;
  start();
  const FileDescriptor client = connect();
  ask(client, "SAFE");
  until([this] { return !arm_may_move(); });
  while (is_waited_for(client)) {
    ++vital().cycles;
    vital().seen_epoch = reinterpret_cast<const PermitPage*>(arm.permit.octets.data())->epoch.load();
    pass(Guard::most_unwatched);
  }
  EXPECT_THAT(lines(client), Contains(EndsWith(" ms, says the device, its subsystem was ended\n")));
}

TEST_F(GuardShellTest, WhoAsksForAnythingElseIsLetGoUnansweredAndStopsNobody) {
  start();
  for (const std::string_view words : {"STOP", "safe", "SAF", "SAFE\n", "SAFESAFE", "SAFESAFESAFE"}) {
    const FileDescriptor client = connect();
    ask(client, words);
    EXPECT_THAT(lines(client), IsEmpty()) << words;
  }
  EXPECT_TRUE(arm_may_move());
  EXPECT_THAT(kinds(), IsEmpty());
}

TEST_F(GuardShellTest, WhoAsksNothingIsLetGoInItsTime) {
  start();
  const FileDescriptor client = connect();
  a_round();
  pass(1s - 1ns);
  EXPECT_TRUE(is_waited_for(client));
  clock.advance(1ns);
  EXPECT_THAT(lines(client), IsEmpty());
  EXPECT_TRUE(arm_may_move());
}

TEST_F(GuardShellTest, WhoHasAskedIsAnsweredThoughItsTimeToAskIsOver) {
  device.mute = true;
  start();
  const FileDescriptor client = connect();
  ask(client, "SAFE");
  until([this] { return !arm_may_move(); });
  a_round();
  pass(5s);
  EXPECT_TRUE(is_waited_for(client)) << "of a pause little counts for whoever is to stop";
  device.mute = false;
  EXPECT_THAT(lines(client), ElementsAre("STOPPED MOTOR stopped 5000 ms, says the device\n",
                                         "STOPPED HAND stopped 0 ms\n", "END 1 2\n"));
}

TEST_F(GuardShellTest, WhoHasGoneBeforeItsAnswerKeepsItFromNobody) {
  device.mute = true;
  start();
  FileDescriptor gone = connect();
  const FileDescriptor other = connect();
  ask(gone, "SAFE");
  ask(other, "SAFE");
  until([this] { return !arm_may_move(); });
  a_round();
  gone.reset();
  device.mute = false;
  EXPECT_EQ(lines(other).size(), 3U);
}

TEST_F(GuardShellTest, OfMoreThanItHasPlacesForTheOldestIsLetGo) {
  start();
  const FileDescriptor oldest = connect();
  a_round();
  std::array<FileDescriptor, 7> others;
  for (FileDescriptor& other : others) other = connect();
  a_round();
  EXPECT_TRUE(is_waited_for(oldest));
  const FileDescriptor newest = connect();
  EXPECT_THAT(lines(oldest), IsEmpty());
  for (const FileDescriptor& other : others) EXPECT_TRUE(is_waited_for(other));
  ask(newest, "SAFE");
  EXPECT_EQ(lines(newest).size(), 3U);
}

TEST_F(GuardShellTest, WhoHasAskedKeepsItsPlaceBeforeWhoHasNot) {
  device.mute = true;
  start();
  std::vector<FileDescriptor> asked;
  for (int i = 0; i < 7; ++i) {
    asked.push_back(connect());
    ask(asked.back(), "SAFE");
  }
  const FileDescriptor silent = connect();
  a_round();
  const FileDescriptor newest = connect();
  EXPECT_THAT(lines(silent), IsEmpty()) << "it is let go";
  ask(newest, "SAFE");
  device.mute = false;
  for (const FileDescriptor& each : asked) EXPECT_FALSE(lines(each).empty());
  EXPECT_FALSE(lines(newest).empty());
}

/// So many actuators that a connection has no room for what is said of them.
struct LongAnswerTest : GuardShellTest {
  static constexpr std::size_t more = 2000;
  void SetUp() override {
    for (std::size_t i = 0; i < more; ++i) {
      auto& device = mission.subsystems[1].subsystem.devices.emplace_back();
      device.name = "FINGER_" + std::to_string(i);
      device.actuator = true;
      device.stop_within = 200ms;
    }
    GuardShellTest::SetUp();
  }
  /// It has asked, and the guard has said what there was room for.
  [[nodiscard]] FileDescriptor asked_and_half_answered() {
    start();
    FileDescriptor client = connect();
    ask(client, "SAFE");
    until([this] { return !arm_may_move(); });
    until([&] { return !is_waited_for(client); });
    a_round();
    return client;
  }
};

TEST_F(LongAnswerTest, WhoReadsSlowlyGetsAllOfIt) {
  const FileDescriptor client = asked_and_half_answered();
  const auto all = lines(client);
  ASSERT_EQ(all.size(), more + 2);
  EXPECT_EQ(all.back(), "END 1 2001\n");
}

TEST_F(LongAnswerTest, WhoDoesNotReadIsLetGoInItsTimeWithoutTheLineThatSaysItIsAll) {
  const FileDescriptor client = asked_and_half_answered();
  pass(1s);
  a_round();
  const auto some = lines(client);
  EXPECT_LT(some.size(), more);
  ASSERT_FALSE(some.empty());
  EXPECT_TRUE(some.back().starts_with("STOPPED FINGER_")) << some.back();
}

TEST_F(GuardShellTest, ASignalStopsEverythingThoughThereIsNoSocket) {
  auto started = GuardShell::start(guard, clock, {}, {});
  ASSERT_TRUE(started);
  ASSERT_EQ(::kill(::getpid(), SIGUSR1), 0);
  until([this] { return !arm_may_move(); });
  EXPECT_THAT(kinds(), ElementsAre(GuardFinding::Kind::StopAsked));
  EXPECT_FALSE(std::filesystem::exists("safe.socket"));
}

TEST_F(GuardShellTest, WhoIsCalledForAStopDoesWhatTheGuardWouldAndTheAnswerIsOfThatStop) {
  std::atomic<int> called{0};
  start({.on_begin = {}, .stop = [&] {
           ++called;
           return guard.stop_all();
         }});
  const FileDescriptor client = connect();
  ask(client, "SAFE");
  EXPECT_EQ(lines(client).size(), 3U);
  EXPECT_EQ(called, 1);
  ASSERT_EQ(::kill(::getpid(), SIGUSR1), 0);
  until([&] { return called == 2; });
  EXPECT_THAT(kinds(), IsEmpty()) << "the guard has stopped nobody by itself";
}

TEST_F(GuardShellTest, WhatIsToBeginIsDoneInItsThreadBeforeTheFirstStep) {
  std::atomic<int> asked_before{-1};
  std::atomic<std::thread::id> thread{};
  const int before = clock.asked();
  start({.on_begin =
             [&] {
               thread = std::this_thread::get_id();
               asked_before = clock.asked();
             },
         .stop = {}});
  a_round();
  EXPECT_EQ(asked_before, before);
  EXPECT_NE(thread.load(), std::this_thread::get_id());
}

TEST_F(GuardShellTest, ItsEndLetsGoOfWhoIsThereAndLeavesNoSocketBehind) {
  start();
  const FileDescriptor client = connect();
  a_round();
  shell.reset();
  EXPECT_THAT(lines(client), IsEmpty());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST_F(GuardShellTest, ASocketOfAFlightThatWasKilledIsInNobodysWay) {
  std::ofstream{folder.path() / "safe.socket"} << "left";
  start();
  const FileDescriptor client = connect();
  ask(client, "SAFE");
  EXPECT_EQ(lines(client).size(), 3U);
}

TEST_F(GuardShellTest, AFolderInWhichNoSocketCanBeIsSaidSo) {
  const auto absent = GuardShell::start(guard, clock, folder.path() / "absent", {});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::SystemFailure);
  EXPECT_EQ(absent.error().value, ENOENT);
  const auto long_path = GuardShell::start(guard, clock, folder.path() / std::string(200, 'x'), {});
  ASSERT_FALSE(long_path);
  EXPECT_EQ(long_path.error().code, ErrorCode::OutOfRange);
}

}  // namespace
}  // namespace hirosco::supervisor
