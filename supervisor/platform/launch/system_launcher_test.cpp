// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/system_launcher.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>
#include <string>

#include "hirosco/data_transfer/channel/socket_channel.hpp"
#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

/// A process whose service loop shares its priority with others, and whose cycle has one of its own; both rest until its end.
pid_t start_realtime() {
  std::array<int, 2> ready{};
  if (::pipe(ready.data()) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    auto cycle = Thread::start("cycle", [&] {
      static_cast<void>(set_fifo_priority(1));
      static_cast<void>(!::write(ready[1], "", 1));
      for (;;) ::pause();
    });
    static_cast<void>(set_shared_priority(1));
    static_cast<void>(!::write(ready[1], "", 1));
    for (;;) ::pause();
  }
  for (char begun = 0, i = 0; i < 2; ++i) static_cast<void>(!::read(ready[0], &begun, 1));
  for (const int end : ready) ::close(end);
  return child;
}

/// The cycle of such a process.
int cycle_of(pid_t process) {
  for (const auto& task : std::filesystem::directory_iterator{"/proc/" + std::to_string(process) + "/task"}) {
    const int thread = std::stoi(task.path().filename().string());
    if (thread != process) return thread;
  }
  return -1;
}

struct Scheduling {
  int policy{-1};
  int priority{-1};
  bool operator==(const Scheduling&) const = default;
};

Scheduling scheduling_of(int thread) {
  sched_param parameters{};
  static_cast<void>(::sched_getparam(thread, &parameters));
  return {::sched_getscheduler(thread) & ~SCHED_RESET_ON_FORK, parameters.sched_priority};
}

/// 0: all is as it should be.
int take_realtime_from_another() {
  const pid_t child = start_realtime();
  const auto process = Process::adopt(child);
  if (!process) return 1;
  const auto grip = grip_of(*process);
  if (!grip) return 2;
  const int cycle = cycle_of(child);
  const Scheduling service_before = scheduling_of(child), cycle_before = scheduling_of(cycle);
  constexpr Scheduling ordinary{SCHED_OTHER, 0};
  int wrong = 0;
  (*grip)->find_threads();
  (*grip)->take_loops_realtime();
  if (scheduling_of(child) != ordinary) wrong = 3;
  if (scheduling_of(cycle) != cycle_before) wrong = 4;
  (*grip)->take_realtime();
  if (scheduling_of(child) != ordinary || scheduling_of(cycle) != ordinary) wrong = 5;
  int status = 0;
  if (::waitpid(child, &status, WNOHANG) != 0) return 6;  // it lives on: it has its grace
  (*grip)->give_realtime();
  if (scheduling_of(child) != service_before || scheduling_of(cycle) != cycle_before) wrong = 7;
  (*grip)->take_realtime();
  if (scheduling_of(child) != ordinary || scheduling_of(cycle) != ordinary) wrong = 8;
  (*grip)->kill();
  ::waitpid(child, &status, 0);
  return wrong;
}

TEST(ProcessGrip, TakesRealTimeAsRoot) { EXPECT_EQ(take_realtime_from_another(), 0); }

TEST(ProcessGrip, TakesRealTimeAsAnOrdinaryUserWhoMayHaveIt) {
  const pid_t user = ::fork();
  if (user == 0) {
    const rlimit most{.rlim_cur = 1, .rlim_max = 1};
    constexpr uid_t nobody = 65'534;
    static_cast<void>(::setrlimit(RLIMIT_RTPRIO, &most));
    if (::getuid() == 0 && (::setgid(nobody) != 0 || ::setuid(nobody) != 0)) ::_exit(9);
    ::_exit(take_realtime_from_another());
  }
  int status = 0;
  ASSERT_EQ(::waitpid(user, &status, 0), user);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

/// A process that counts in a thread of this name, and rests in its first, or counts there.
pid_t start_busy(const char* name, int most) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::atomic<int> count{0};
  const auto busy = [&] {
    while (count < most) ++count;
    for (;;) ::pause();
  };
  auto other = name != nullptr ? Thread::start(name, busy) : Result<Thread>{Thread{}};
  if (name == nullptr) busy();
  for (;;) ::pause();
}

TEST(ProcessGrip, TellsWhatTheServiceLoopHasHadAndWhetherItCouldRun) {
  for (const char* name : {static_cast<const char*>(nullptr), "worker", "cycle"}) {
    const pid_t child = start_busy(name, std::numeric_limits<int>::max());
    const auto process = Process::adopt(child);
    ASSERT_TRUE(process);
    const auto grip = grip_of(*process).value();
    while (grip->processor_time() < 50ms) ::sched_yield();
    grip->find_threads();
    const LoopTime time = grip->loop_time();
    if (name == nullptr) {
      EXPECT_TRUE(time.runnable);
      EXPECT_GT(time.service, 10ms);
    } else {
      EXPECT_FALSE(time.runnable) << name;
      EXPECT_EQ(time.service / 30ms, 0) << name;
    }
    EXPECT_EQ(time.realtime, 0ms) << "none of them has any";
    grip->kill();
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_FALSE(grip->loop_time().runnable) << "it is gone";
  }
}

/// A program of a mission in a folder of its own, which is the first of PATH.
struct ManifestStart : ::testing::Test {
  TestFolder folder;
  std::string path_before{std::getenv("PATH")};
  descriptor::Mission mission;
  SystemLauncher launcher;
  void SetUp() override {
    ::setenv("PATH", (folder.path().string() + ":" + path_before).c_str(), 1);
    is_now("/bin/true");
    descriptor::MissionSubsystem lamp;
    lamp.executable = "hirosco-test-lamp";
    lamp.subsystem.name = "LAMP";
    lamp.subsystem.file = "lamp.xml";
    mission.subsystems = {lamp};
    mission.manifest = descriptor::Manifest{"manifest.sha256", {}};
    mission.manifest->listed = {{lamp.executable, ProgramImage::read("/bin/true").value().digest(), {}}};
  }
  ~ManifestStart() override { ::setenv("PATH", path_before.c_str(), 1); }
  void is_now(const char* program) {
    std::filesystem::copy_file(program, folder.path() / "hirosco-test-lamp",
                               std::filesystem::copy_options::overwrite_existing);
  }
  /// Its exit code; nothing when it is not started.
  std::optional<int> run() {
    auto launched = launcher.launch(mission.subsystems[0]);
    if (!launched) return std::nullopt;
    for (;;)
      if (const auto end = launcher.ended(launched->process)) return end->value;
  }
};

TEST_F(ManifestStart, IsOfWhatWasReadBeforeTheFlightWhateverBecomesOfTheFile) {
  EXPECT_EQ(launcher.hold_to(mission).count(), 1U);
  EXPECT_EQ(run(), 0);
  is_now("/bin/false");
  EXPECT_FALSE(launcher.refuse(mission.subsystems[0]));
  EXPECT_EQ(run(), 0);
}

TEST_F(ManifestStart, UnderWhoGoesOnIsReadBesideTheFlightAndHeldAllTheSame) {
  KeeperPage page;
  page.starts = 2;
  ASSERT_TRUE(launcher.keep_with(StoreClient{-1}, mission, {}, &page));
  EXPECT_EQ(launcher.begin(mission).value(), "executables of the manifest are read anew, beside the flight");
  while (launcher.refuse(mission.subsystems[0])) {}
  is_now("/bin/false");
  EXPECT_EQ(run(), 0);
}

TEST_F(ManifestStart, OfAnotherFileIsRefused) {
  is_now("/bin/false");
  EXPECT_EQ(run(), 1) << "without a manifest it is the name that counts";
  EXPECT_EQ(launcher.hold_to(mission).count(), 0U);
  EXPECT_EQ(run(), std::nullopt);
  EXPECT_EQ(launcher.refuse(mission.subsystems[0]).value().why.code, ErrorCode::Mismatch);
  is_now("/bin/true");
  EXPECT_EQ(run(), 0);
}

TEST_F(ManifestStart, MakesTheControlChannelAsLargeAsTheDescriptorSaysOrIsRefused) {
  auto& channel_kb = mission.subsystems[0].subsystem.resources.channel_kb;
  channel_kb = 64;
  auto launched = launcher.launch(mission.subsystems[0]);
  ASSERT_TRUE(launched);
  int octets = 0;
  socklen_t length = sizeof octets;
  EXPECT_EQ(::getsockopt(launched->port->channel().wait_descriptor(), SOL_SOCKET, SO_SNDBUF, &octets, &length), 0);
  EXPECT_EQ(octets, 64 * 1024);
  while (!launcher.ended(launched->process)) {}
  channel_kb = 1U << 20;  // a gigabyte
  const auto refused = launcher.launch(mission.subsystems[0]);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::ResourceExhausted);
}

/// Of LAMP, with a device in shared memory there.
descriptor::MissionSubsystem in_memory(const descriptor::MissionSubsystem& lamp, const std::string& address) {
  descriptor::MissionSubsystem made = lamp;
  descriptor::DeviceUse use;
  use.endnode.transfer = Transfer::SharedMemory;
  use.endnode.address = address;
  made.subsystem.configurations.emplace_back().devices.push_back(use);
  return made;
}

TEST_F(ManifestStart, FindsTheFolderOfItsDeviceAndOfItsFallBackInPlaceWhoeverComesFirst) {
  const std::string address = "launched." + std::to_string(::getpid());
  mission.subsystems[0] = in_memory(mission.subsystems[0], address);
  auto& use = mission.subsystems[0].subsystem.configurations[0].devices[0];
  use.fall_backs = {use.endnode};
  use.fall_backs[0].address += "-b";
  EXPECT_EQ(run(), 0);
  for (const char* which : {"", "-b"}) {
    EXPECT_EQ(std::filesystem::is_directory(device_memory_folder(address + which)), !sandbox_is_off()) << which;
    remove_device_memory_folder(address + which);
  }
}

TEST_F(ManifestStart, ShutsOutOfTheFramesOfADeviceThatItsDescriptorDidNotName) {
  const auto lamp = in_memory(mission.subsystems[0], "lamp"), other = in_memory(mission.subsystems[0], "other");
  EXPECT_EQ(launcher.shut_out(0, lamp, lamp), "");
  EXPECT_EQ(launcher.shut_out(0, lamp, other), "/dev/shm/hirosco/other");
}

TEST_F(ManifestStart, ThatFailsForWantOfADescriptorAtWhicheverStepLeavesNoProcessBehind) {
  rlimit all{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &all), 0);
  const FileDescriptor next{::dup(STDIN_FILENO)};
  int failed = 0;
  bool started = false;
  constexpr int most = 64;
  for (int left = 1; left <= most && !started; ++left) {
    rlimit few = all;
    few.rlim_cur = static_cast<rlim_t>(next.get() + left);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
    auto launched = launcher.launch(mission.subsystems[0]);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &all), 0);
    if (!launched && launched.error().code == ErrorCode::Unavailable) {  // still being read, beside this
      --left;
      continue;
    }
    started = launched.has_value();
    failed += started ? 0 : 1;
    while (launcher.any_running()) {}
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << left << " left: a zombie, or one that goes on";
  }
  EXPECT_TRUE(started);
  EXPECT_GT(failed, 10);
}

/// Of a process that rests, with pages as a supervisor before had kept them.
std::array<FileDescriptor, kept_roles> kept_of(pid_t process, SealedMemory& memory, const PermitPage& permit) {
  std::array<FileDescriptor, kept_roles> kept;
  const auto page = [&](KeptRole role, const auto& content) {
    const auto handle = memory.create("page", sizeof content).value();
    std::memcpy(memory.map(handle, Access::ReadWrite).value().octets.data(), static_cast<const void*>(&content),
                sizeof content);
    if (role == KeptRole::Permit) static_cast<void>(memory.seal_writers(handle));
    kept[static_cast<std::size_t>(role)] = FileDescriptor{::dup(SealedMemory::descriptor(handle))};
  };
  page(KeptRole::Vital, VitalPage{});
  page(KeptRole::Permit, permit);
  kept[static_cast<std::size_t>(KeptRole::Channel)] = std::move(SocketChannel::make_pair().value().first);
  kept[static_cast<std::size_t>(KeptRole::Process)] =
      FileDescriptor{static_cast<int>(::syscall(SYS_pidfd_open, process, 0))};
  return kept;
}

pid_t start_one_that_rests() {
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (;;) ::pause();
  }
  return child;
}

TEST(SystemLauncherAdoption, WhomTheKeeperCouldNotTakeIsToldOnceWhenItSaysSo) {
  const pid_t child = start_one_that_rests();
  descriptor::Mission mission;
  mission.subsystems.emplace_back().subsystem.name = "ARM";
  SealedMemory memory;
  InheritedParts inherited;
  inherited.emplace(0, kept_of(child, memory, PermitPage{}));
  auto ends = std::move(*KeptStore::make_socket());
  KeeperPage page;
  page.not_taken[0] = 1;  // of what a supervisor before had handed over
  SystemLauncher launcher;
  ASSERT_TRUE(launcher.keep_with(StoreClient{ends.second.get()}, mission, std::move(inherited), &page));
  const auto adopted = launcher.adopt(mission.subsystems[0]);
  ASSERT_TRUE(adopted);
  EXPECT_EQ(launcher.take_not_kept(adopted->launched.process), "") << "of this one it has said nothing yet";
  page.not_taken[0] = 1;
  EXPECT_NE(launcher.take_not_kept(adopted->launched.process), "");
  EXPECT_EQ(launcher.take_not_kept(adopted->launched.process), "") << "once";
  EXPECT_EQ(launcher.take_not_kept(adopted->launched.process + 1), "") << "there is no such process";
  launcher.kill_all();
  ::waitpid(child, nullptr, 0);
}

TEST(SystemLauncherAdoption, OfWhomTheKeeperHeldTheHandleAloneIsEndedByIt) {
  const pid_t child = start_one_that_rests();
  descriptor::Mission mission;
  mission.subsystems.emplace_back().subsystem.name = "ARM";
  const auto handle = [&] { return FileDescriptor{static_cast<int>(::syscall(SYS_pidfd_open, child, 0))}; };
  const FileDescriptor ours = handle();
  InheritedParts inherited;
  for (FileDescriptor& each : inherited[0]) each = handle();
  SystemLauncher launcher;
  ASSERT_TRUE(launcher.keep_with(StoreClient{-1}, mission, std::move(inherited), nullptr));
  const auto adopted = launcher.adopt(mission.subsystems[0]);
  ASSERT_FALSE(adopted);
  EXPECT_NE(adopted.error().why, "") << "it lived";
  pollfd ended{ours.get(), POLLIN, 0};
  constexpr int without_limit = -1;
  EXPECT_EQ(::poll(&ended, 1, without_limit), 1);
  ::waitpid(child, nullptr, 0);
}

TEST(SystemLauncherAdoption, ThePageThatItMakesSaysWhatItFoundBeforeAnyGuardHasWrittenOnIt) {
  const pid_t child = start_one_that_rests();
  descriptor::Mission mission;
  mission.subsystems.emplace_back().subsystem.name = "ARM";
  SealedMemory memory;
  PermitPage before;
  before.epoch = 4711;
  before.fence();
  before.powered = power_on;
  InheritedParts inherited;
  inherited.emplace(0, kept_of(child, memory, before));
  SystemLauncher launcher;
  ASSERT_TRUE(launcher.keep_with(StoreClient{-1}, mission, std::move(inherited), nullptr));
  const auto adopted = launcher.adopt(mission.subsystems[0]);
  ASSERT_TRUE(adopted);
  const auto& page = *reinterpret_cast<const PermitPage*>(adopted->launched.permit.octets.data());
  EXPECT_EQ(page.epoch.load(), 4712u);
  EXPECT_EQ(page.stop.load(), 1u);
  EXPECT_EQ(page.powered.load(), power_on);
  EXPECT_FALSE(page.permits(page.epoch.load()));
  launcher.kill_all();
  ::waitpid(child, nullptr, 0);
}

/// In a process of its own that has `left` descriptors besides those that it has inherited. 0: the one that rests was not adopted for a
/// reason that was told, counted as dead only when it had gone, and has gone.
int goes_on_short_of_descriptors(pid_t resting, int left) {
  descriptor::Mission mission;
  mission.subsystems.emplace_back().subsystem.name = "ARM";
  SealedMemory memory;
  InheritedParts inherited;
  inherited.emplace(0, kept_of(resting, memory, PermitPage{}));
  const FileDescriptor handle{static_cast<int>(::syscall(SYS_pidfd_open, resting, 0))};
  SystemLauncher launcher;
  if (!launcher.keep_with(StoreClient{-1}, mission, std::move(inherited), nullptr)) return 1;
  const FileDescriptor first_free{::open("/dev/null", O_RDONLY | O_CLOEXEC)};
  const auto most = static_cast<rlim_t>(first_free.get() + 1 + left);
  const rlimit limit{.rlim_cur = most, .rlim_max = most};
  if (::setrlimit(RLIMIT_NOFILE, &limit) != 0) return 2;
  const auto adopted = launcher.adopt(mission.subsystems[0]);
  if (adopted) return 3;
  if (adopted.error().why.empty()) return 4;
  pollfd look{handle.get(), POLLIN, 0};
  const bool counts_as_dead = adopted.error().process == 0;
  if (counts_as_dead && ::poll(&look, 1, 0) != 1) return 5;
  // On a computer that took longer than the launcher waits it is told as living still; ended it is all the same.
  constexpr int without_limit = -1;
  return ::poll(&look, 1, without_limit) == 1 ? 0 : 6;
}

TEST(SystemLauncherAdoption, WhoLivesAndCannotBeGoneOnWithIsEndedAndHasGoneBeforeItCountsAsDead) {
  // With one for its id but none for its new page, and with none at all.
  for (const int left : {1, 0}) {
    const pid_t resting = ::fork();
    if (resting == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      for (;;) ::pause();
    }
    static_cast<void>(::kill(resting, SIGSTOP));
    const pid_t short_of = ::fork();
    if (short_of == 0) ::_exit(goes_on_short_of_descriptors(resting, left));
    int status = 0;
    ASSERT_EQ(::waitpid(short_of, &status, 0), short_of);
    EXPECT_TRUE(WIFEXITED(status)) << left;
    EXPECT_EQ(WEXITSTATUS(status), 0) << left;
    static_cast<void>(::kill(resting, SIGTERM));  // where it was let go
    static_cast<void>(::kill(resting, SIGCONT));
    ASSERT_EQ(::waitpid(resting, &status, 0), resting);
    EXPECT_TRUE(WIFSIGNALED(status)) << left;
    EXPECT_EQ(WTERMSIG(status), SIGKILL) << left;
  }
}

}  // namespace
}  // namespace hirosco::supervisor
