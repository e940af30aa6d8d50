// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/instance.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <sys/socket.h>

#include <fstream>

namespace hirosco::tools {
namespace {

namespace fs = std::filesystem;

/// Nobody else on a computer uses this one.
constexpr const char* test_host = "127.0.0.9";

class Flights : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "hirosco-flights-test-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] static FlightEntry entry(const std::string& instance, double load = 0) {
    return {.instance = instance,
            .mission = "RANGER",
            .file = "/m/ranger/mission.xml",
            .folder = "/run/" + instance,
            .log = "/l/" + instance + ".db",
            .telemetry = std::string{test_host} + ":31015",
            .telecommand = std::string{test_host} + ":31025",
            .cores = {.shared_load = load},
            .keeper = 7};
  }
  fs::path folder_;
};

/// Listens on a port, as a foreign program does.
FileDescriptor listener(std::uint16_t port) {
  FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  EXPECT_EQ(::inet_pton(AF_INET, test_host, &address.sin_addr), 1);
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(::listen(socket.get(), 1), 0);
  return socket;
}

std::string reason(const std::expected<Admission, std::string>& refused) {
  return refused ? std::string{"it was let in"} : refused.error();
}

TEST_F(Flights, AreFoundAsLongAsOneOfTheirProcessesLives) {
  const FlightRegistry registry{folder_ / "registry"};
  EXPECT_TRUE(registry.flights().empty());
  auto first = registry.enter(entry("RANGER"));
  ASSERT_TRUE(first) << first.error();
  auto heir = first->lock.duplicate();
  ASSERT_TRUE(heir);
  first->lock.reset();
  ASSERT_EQ(registry.flights().size(), 1U) << "a process that inherited it holds it";
  const FlightEntry found = registry.flights().front();
  EXPECT_EQ(found.instance, "RANGER");
  EXPECT_EQ(found.mission, "RANGER");
  EXPECT_EQ(found.folder, "/run/RANGER");
  EXPECT_EQ(found.log, "/l/RANGER.db");
  EXPECT_EQ(found.telemetry, "127.0.0.9:31015") << "a flight of its mission's name listens where the mission says";
  EXPECT_EQ(found.telecommand, "127.0.0.9:31025");
  EXPECT_EQ(found.keeper, 7);
  heir->reset();
  EXPECT_TRUE(registry.flights().empty()) << "nothing has to be cleaned up";
}

TEST_F(Flights, OfOneNameThereIsOneOnly) {
  const FlightRegistry registry{folder_};
  const auto first = registry.enter(entry("one"));
  ASSERT_TRUE(first);
  EXPECT_EQ(reason(registry.enter(entry("one"))), "one flies already");
  EXPECT_TRUE(registry.enter(entry("two")));
}

TEST_F(Flights, WithANameOfTheirOwnGetTheFirstPortsThatNobodyHas) {
  const FlightRegistry registry{folder_};
  const FileDescriptor foreign = listener(31225);
  const auto one = registry.enter(entry("one"));
  ASSERT_TRUE(one) << one.error();
  EXPECT_EQ(one->flight.telemetry, "127.0.0.9:31115");
  EXPECT_EQ(one->flight.telecommand, "127.0.0.9:31125");
  const auto two = registry.enter(entry("two"));
  ASSERT_TRUE(two) << two.error();
  EXPECT_EQ(two->flight.telemetry, "127.0.0.9:31315")
      << "31115 is the first one's though it does not listen yet, 31225 a foreign program's";
  EXPECT_EQ(registry.flights().back().telemetry, "127.0.0.9:31315");
}

TEST_F(Flights, WhosePortsAreTakenAreRefused) {
  const FlightRegistry registry{folder_};
  const FileDescriptor foreign = listener(31025);
  EXPECT_NE(reason(registry.enter(entry("RANGER"))).find("127.0.0.9:31025: somebody listens there"), std::string::npos);
  EXPECT_TRUE(registry.enter(entry("one"))) << "another name has other ports";
}

TEST_F(Flights, OfAMissionWithoutGroundLinkNeedNoPorts) {
  FlightEntry silent = entry("one");
  silent.telemetry.clear();
  silent.telecommand.clear();
  const FlightRegistry registry{folder_};
  const auto entered = registry.enter(silent);
  ASSERT_TRUE(entered) << entered.error();
  EXPECT_EQ(registry.flights().front().telemetry, "");
}

TEST_F(Flights, ThatTogetherNeedMoreThanTheProcessorAreRefused) {
  const FlightRegistry registry{folder_};
  auto first = registry.enter(entry("one", 0.6));
  ASSERT_TRUE(first);
  const std::string refused = reason(registry.enter(entry("two", 0.5)));
  EXPECT_NE(refused.find("need 110 %"), std::string::npos) << refused;
  EXPECT_NE(refused.find("this one 50 %, one 60 %"), std::string::npos) << refused;
  EXPECT_EQ(registry.flights().size(), 1U);
  EXPECT_TRUE(registry.enter(entry("two", 0.4))) << "all of it, and no more";
  first->lock.reset();
  EXPECT_TRUE(registry.enter(entry("two", 0.5))) << "who does not fly any more needs nothing";
}

TEST_F(Flights, WhoseDevicesAreAtOneUdpAddressAreRefused) {
  const FlightRegistry registry{folder_};
  FlightEntry one = entry("one");
  one.udp = {"127.0.0.1:5000", "127.0.0.1:5001"};
  FlightEntry two = entry("two");
  two.udp = {"127.0.0.1:5001"};
  const auto first = registry.enter(one);
  ASSERT_TRUE(first);
  EXPECT_EQ(reason(registry.enter(two)), "one has the devices at 127.0.0.1:5001 already");
}

TEST_F(Flights, OfAFolderThatIsNotOursAreRefusedAndNotBelieved) {
  std::ofstream{folder_ / "registry"} << "a file";
  const FlightRegistry registry{folder_ / "registry"};
  EXPECT_NE(reason(registry.enter(entry("one"))).find("no folder of yours"), std::string::npos);
  EXPECT_TRUE(registry.flights().empty());
  fs::create_directory_symlink(folder_, folder_ / "link");
  EXPECT_NE(reason(FlightRegistry{folder_ / "link"}.enter(entry("one"))).find("no folder of yours"), std::string::npos);
}

TEST_F(Flights, WithAPathThatWouldSayMoreThanAPathAreRefused) {
  const FlightRegistry registry{folder_};
  FlightEntry forged = entry("one");
  forged.log = "/l/one.db\nkeeper=0";
  EXPECT_NE(reason(registry.enter(forged)).find("characters"), std::string::npos);
}

TEST(Choice, IsTheOnlyFlightThatIsMeantElseAskedForByNames) {
  const auto flight = [](const std::string& instance, const std::string& mission) {
    return FlightEntry{.instance = instance, .mission = mission, .file = {}, .folder = "/f", .log = {}};
  };
  EXPECT_FALSE(*choose_flight({}, {}));
  EXPECT_EQ((*choose_flight({flight("RANGER", "RANGER")}, {}))->instance, "RANGER");
  const std::vector<FlightEntry> several{flight("RANGER", "RANGER"), flight("harbour-1", "HARBOUR"),
                                         flight("two", "RANGER")};
  EXPECT_EQ((*choose_flight(several, {.mission = {}, .instance = "two"}))->instance, "two");
  EXPECT_EQ((*choose_flight(several, {.mission = "HARBOUR", .instance = {}}))->instance, "harbour-1");
  EXPECT_FALSE(*choose_flight(several, {.mission = "OTHER", .instance = {}}))
      << "another mission's flight is not meant";
  const auto which = choose_flight(several, {.mission = "RANGER", .instance = {}});
  ASSERT_FALSE(which);
  EXPECT_NE(which.error().find("2 flights are in the air; which one?"), std::string::npos) << which.error();
  EXPECT_NE(which.error().find("--instance two"), std::string::npos) << which.error();
  EXPECT_EQ(which.error().find("harbour-1"), std::string::npos) << which.error();
}

TEST(Choice, OfANameThatDoesNotFlySaysWhichOnesDo) {
  const std::vector<FlightEntry> flights{
      {.instance = "one", .mission = "RANGER", .file = {}, .folder = "/f", .log = {}}};
  const auto wrong = choose_flight(flights, {.mission = {}, .instance = "won"});
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().find("no instance 'won' flies; there are:"), std::string::npos) << wrong.error();
  EXPECT_NE(wrong.error().find("one"), std::string::npos);
  const auto none = choose_flight({}, {.mission = {}, .instance = "won"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error(), "no instance 'won' flies; nothing flies here");
  const auto other = choose_flight(flights, {.mission = "HARBOUR", .instance = "one"});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error(), "instance 'one' flies mission RANGER, not HARBOUR");
}

descriptor::Mission some_mission() {
  descriptor::Mission mission;
  mission.name = "RANGER";
  mission.database.path = "log/ranger.db";
  mission.ground.subsystem = "RADIO";
  mission.ground.telemetry = "localhost:31015";
  mission.ground.telecommand = "127.0.0.1:31025";
  return mission;
}

TEST(Instance, OfTheMissionsOwnNameHasWhatTheMissionSays) {
  const FlightEntry own = plan_flight(some_mission(), "RANGER");
  EXPECT_FALSE(own.named());
  EXPECT_EQ(own.telemetry, "127.0.0.1:31015") << "in numbers";
  EXPECT_EQ(own.telecommand, "127.0.0.1:31025");
  EXPECT_EQ(own.log, fs::absolute("log/ranger.db"));
  EXPECT_EQ(own.folder, runtime_folder("RANGER"));
}

TEST(Instance, OfAnotherNameHasALogAnArchiveAndAFolderOfItsOwn) {
  const descriptor::Mission mission = some_mission();
  const FlightEntry other = plan_flight(mission, "ground");
  EXPECT_TRUE(other.named());
  EXPECT_EQ(other.log, fs::absolute("log/ground/ranger.db"));
  EXPECT_EQ(archive_beside(other.log), fs::absolute("log/ground/ranger-ground.db"));
  EXPECT_EQ(other.folder, runtime_folder("ground"));
  EXPECT_EQ(instance_of_folder(other.folder), "ground");
}

TEST(Instance, KnowsTheUdpAddressesOfItsDevices) {
  descriptor::Mission mission = some_mission();
  descriptor::MissionSubsystem member;
  descriptor::Device device;
  const auto endnode = [](Transfer transfer, const char* address) {
    descriptor::Endnode made;
    made.transfer = transfer;
    made.address = address;
    return made;
  };
  device.enable = endnode(Transfer::Udp, "127.0.0.1:5001");
  member.subsystem.devices.push_back(device);
  descriptor::Configuration configuration;
  for (const auto& used : {endnode(Transfer::Udp, "127.0.0.1:5000"), endnode(Transfer::Udp, "127.0.0.1:5000"),
                           endnode(Transfer::Unix, "/tmp/x")})
    configuration.devices.emplace_back().endnode = used;
  member.subsystem.configurations.push_back(configuration);
  mission.subsystems.push_back(member);
  EXPECT_EQ(plan_flight(mission, "one").udp, (std::vector<std::string>{"127.0.0.1:5000", "127.0.0.1:5001"}));
}

TEST(Instance, NamesThatWouldLeaveTheirFolderAreNone) {
  for (const std::string& name : {std::string{}, std::string{"."}, std::string{".."}, std::string{".lock"},
                                  std::string{"a/b"}, std::string{"a b"}, std::string{"ä"}, std::string(65, 'a')})
    EXPECT_FALSE(good_instance(name)) << name;
  EXPECT_TRUE(good_instance("ranger-2"));
  EXPECT_TRUE(good_instance(std::string(64, 'a'))) << "as long as a mission's name";
}

TEST(LogLock, IsOneFlightsAtATime) {
  std::string pattern = (fs::temp_directory_path() / "hirosco-lock-test-XXXXXX").string();
  const fs::path folder = ::mkdtemp(pattern.data());
  const auto first = take_lock(folder / "log.lock");
  EXPECT_TRUE(first);
  EXPECT_EQ(take_lock(folder / "log.lock").error().code, ErrorCode::Unavailable);
  EXPECT_EQ(take_lock(folder / "no" / "log.lock").error().code, ErrorCode::SystemFailure);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace hirosco::tools
