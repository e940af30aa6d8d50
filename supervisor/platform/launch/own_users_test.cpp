// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/own_users.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/private_folder.hpp"
#include "hirosco/descriptor/model/member_reach.hpp"
#include "hirosco/utilities/os/own_user.hpp"
#include "supervisor/platform/launch/subsystem_sandbox.hpp"
#include "supervisor/platform/launch/system_launcher.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

namespace fs = std::filesystem;

constexpr descriptor::UserNumbers some_users{60'600, 60'699};
constexpr std::uint32_t lamp_user = 60'600;
constexpr unsigned to_read = 4;

/// A mission of LAMP in a folder that everybody comes to, whose program rests until it is ended.
struct LampMission {
  TestFolder folder;
  descriptor::Mission mission;
  LampMission() {
    fs::permissions(folder.path(), fs::perms{0755});
    const fs::path program = folder.path() / "hirosco-test-lamp";
    // In its sandbox it starts no other program that would rest for it, and its channel lets nobody wait.
    std::ofstream{program} << "#!/bin/sh\nkill -STOP $$\n";
    fs::permissions(program, fs::perms{0755});
    std::ofstream{folder.path() / "lamp.xml"} << "<Subsystem/>";
    descriptor::MissionSubsystem lamp;
    lamp.executable = program.filename();
    lamp.subsystem.name = "LAMP";
    lamp.subsystem.file = folder.path() / "lamp.xml";
    lamp.user = lamp_user;
    mission.subsystems = {lamp};
    mission.users = some_users;
  }
  void add_device(Transfer transfer, const std::string& address) {
    descriptor::DeviceUse use;
    use.endnode.transfer = transfer;
    use.endnode.address = address;
    mission.subsystems[0].subsystem.configurations.emplace_back().devices.push_back(use);
  }
  [[nodiscard]] fs::path place(const char* name) const { return folder.path() / name; }
};

TEST(OwnUsers, GetAtWhatModesPermitToOthersToTheirGroupOrToThem) {
  const LampMission lamp;
  const fs::path file = lamp.place("lamp.xml");
  fs::permissions(file, fs::perms{0644});
  EXPECT_EQ(closed_to(lamp_user, file, to_read), "");
  fs::permissions(file, fs::perms{0640});
  EXPECT_EQ(closed_to(lamp_user, file, to_read), file);
  EXPECT_EQ(closed_to(::getuid(), file, to_read), "") << "it is his";
  EXPECT_EQ(closed_to(lamp_user, lamp.place("nowhere"), to_read), "") << "what is not there is another's to tell";
  fs::permissions(file, fs::perms{0644});
  fs::permissions(lamp.folder.path(), fs::perms{0700});
  EXPECT_EQ(closed_to(lamp_user, file, to_read), lamp.folder.path()) << "the way to it counts";
  fs::permissions(lamp.folder.path(), fs::perms{0711});
  EXPECT_EQ(closed_to(lamp_user, file, to_read), "") << "nobody looks into a folder on the way";
}

TEST(OwnUsers, AreToldWhichFileOfTheirsIsClosedBeforeTheyFly) {
  const LampMission lamp;
  const auto closed = [&] {
    return what_is_closed(lamp.mission.subsystems[0], lamp_user, lamp.place("hirosco-test-lamp"), "");
  };
  EXPECT_EQ(closed(), "");
  fs::permissions(lamp.place("lamp.xml"), fs::perms{0600});
  EXPECT_EQ(closed(), "may not read " + lamp.place("lamp.xml").string() + ": " + lamp.place("lamp.xml").string() +
                          " is closed to it");
  fs::permissions(lamp.place("hirosco-test-lamp"), fs::perms{0700});
  EXPECT_TRUE(closed().starts_with("may not execute ")) << closed();
}

TEST(OwnUsers, AreToldWhichFolderIsClosedOnTheWayToThatOfADeviceOfTheirs) {
  LampMission lamp;
  lamp.add_device(Transfer::Unix, lamp.place("device"));
  const auto closed = [&] { return what_is_closed(lamp.mission.subsystems[0], lamp_user, {}, ""); };
  EXPECT_EQ(closed(), "") << "it is to be made yet";
  fs::permissions(lamp.folder.path(), fs::perms{0700});
  lamp.mission.subsystems[0].subsystem.file = "/dev/null";
  EXPECT_EQ(closed(), "may not come to " + lamp.place("device").string() + ": " + lamp.folder.path().string() +
                          " is closed to it");
}

TEST(OwnUsers, AreGivenByWhoMayEndThemAloneAndToNobodyWhoDoesNotAsk) {
  const LampMission lamp;
  EXPECT_NE(why_one_user(lamp.mission, false), "") << "whatever the supervisor may, its keeper ends what that leaves";
  descriptor::Mission plain;
  EXPECT_EQ(why_one_user(plain, false), "");
  const SystemLauncher launcher{true};
  EXPECT_THAT(launcher.isolation_not_asked(), HasSubstr("all of the user who flies"));
}

/// Needs the rights: testing/with_own_users.
struct OwnUserLaunch : ::testing::Test {
  LampMission lamp;
  std::string path_before{std::getenv("PATH")};
  void SetUp() override {
    ASSERT_EQ(why_one_user(lamp.mission, true), "");
    ::setenv("PATH", (lamp.folder.path().string() + ":" + path_before).c_str(), 1);
  }
  void TearDown() override { ::setenv("PATH", path_before.c_str(), 1); }
  static ProcessEnd end_of(SystemLauncher& launcher, std::uint32_t process) {
    for (;;)
      if (const auto end = launcher.ended(process)) return *end;
  }
};

TEST_F(OwnUserLaunch, IsOfTheUserThatTheMissionGivesItAndIsEndedAllTheSame) {
  SystemLauncher launcher{true};
  ASSERT_TRUE(launcher.begin(lamp.mission));
  EXPECT_EQ(launcher.isolation_not_asked(), "");
  EXPECT_THAT(launcher.isolation_lacks(), Not(Contains(HasSubstr("one user"))));
  const auto launched = launcher.launch(lamp.mission.subsystems[0]);
  ASSERT_TRUE(launched) << launched.error().text;
  EXPECT_THAT(process_of_users(lamp_user, lamp_user), Not(IsEmpty()));
  launched->grip->kill();  // as the guard does
  const ProcessEnd end = end_of(launcher, launched->process);
  EXPECT_TRUE(end.by_signal);
  EXPECT_EQ(end.value, SIGKILL);
  EXPECT_THAT(process_of_users(lamp_user, lamp_user), IsEmpty());
}

TEST_F(OwnUserLaunch, IsOfTheUserWhoFliesAndThatIsToldWhereItsKeeperDoesNotSayThatItMayEndIt) {
  SystemLauncher launcher{false};
  ASSERT_TRUE(launcher.begin(lamp.mission));
  EXPECT_THAT(launcher.isolation_lacks(), Contains(HasSubstr("all are of one user")));
  const auto launched = launcher.launch(lamp.mission.subsystems[0]);
  ASSERT_TRUE(launched) << launched.error().text;
  EXPECT_THAT(process_of_users(some_users.first, some_users.last), IsEmpty());
  launcher.kill(launched->process);
  EXPECT_TRUE(end_of(launcher, launched->process).by_signal);
}

TEST_F(OwnUserLaunch, HasTheFoldersOfItsDevicesForItselfOrTheFlightDoesNotBegin) {
  const std::string address = "own." + std::to_string(::getpid());
  auto& subsystem = lamp.mission.subsystems[0];
  lamp.add_device(Transfer::SharedMemory, address);
  lamp.add_device(Transfer::Unix, lamp.place("device"));
  const OwnGroup own{lamp_user, {some_users.first, some_users.last}};
  const auto make = [&] { return make_own_places(subsystem, own, "", PlaceTime::BeforeFlight); };
  SystemLauncher launcher{true};
  ASSERT_TRUE(launcher.begin(lamp.mission));
  ASSERT_TRUE(make());
  subsystem.user.reset();  // as a mission says that is read again in flight
  auto launched = launcher.launch(subsystem);
  ASSERT_TRUE(launched) << launched.error().text;
  EXPECT_THAT(process_of_users(lamp_user, lamp_user), Not(IsEmpty()));
  EXPECT_TRUE(is_private_folder(device_memory_folder(address), lamp_user));
  EXPECT_TRUE(is_private_folder(lamp.place("device"), lamp_user));
  EXPECT_THAT(sandbox_of(subsystem, {}, "", ProcessUser::ItsOwn).writable,
              ElementsAre("/dev/null", device_memory_folder(address), lamp.place("device").string()))
      << "not the one that all sockets are in";
  auto fresh = subsystem;
  EXPECT_EQ(launcher.shut_out(launched->process, subsystem, fresh), "");
  fresh.subsystem.configurations[1].devices[0].endnode.address += "-b";
  EXPECT_EQ(launcher.shut_out(launched->process, subsystem, fresh), lamp.place("device-b"));
  launcher.kill(launched->process);
  static_cast<void>(end_of(launcher, launched->process));
  fs::permissions(lamp.place("device"), fs::perms{0777});
  // One that others are in is not shut behind them.
  const auto why = make();
  ASSERT_FALSE(why);
  EXPECT_THAT(why.error(), HasSubstr("cannot be the folder of LAMP's device, who is user 60600"));
  for (const FlowAddress& flow : descriptor::flows_of(subsystem.subsystem)) remove_place(flow, "", ProcessUser::ItsOwn);
  EXPECT_FALSE(fs::exists(device_memory_folder(address)));
  EXPECT_FALSE(fs::exists(lamp.place("device")));
}

}  // namespace
}  // namespace hirosco::supervisor
