// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/exchanged_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"

namespace hirosco {
namespace {

namespace fs = std::filesystem;

ino_t number_of(const std::string& file) {
  struct stat found{};
  return ::lstat(file.c_str(), &found) == 0 ? found.st_ino : 0;
}

struct ExchangedFolder : ::testing::Test {
  const std::string address = "test-exchanged." + std::to_string(::getpid());
  const std::string place = device_memory_folder(address), spare = "/dev/shm/test-spare." + std::to_string(::getpid());
  const FlowAddress flow{Transfer::SharedMemory, address};
  SystemFlowFactory flows{""};
  ino_t spare_number{0}, place_number{0};

  void SetUp() override {
    make_device_memory_folder(address).value();
    ASSERT_EQ(::mkdir(spare.c_str(), 0700), 0);
    spare_number = number_of(spare);
    place_number = number_of(place);
  }
  void TearDown() override {
    fs::remove_all(place);
    fs::remove_all(spare);
  }
  [[nodiscard]] bool stands_at_the_place(ino_t number) const { return number_of(place) == number; }
  /// What the device sends the subsystem hears.
  [[nodiscard]] bool is_heard(DataFlow& device) {
    const auto subsystem = flows.open(flow, FlowSide::Subsystem);
    std::array<std::byte, 8> buffer{};
    return subsystem && device.send(std::array{std::byte{7}}) && (*subsystem)->receive(buffer).value().octets == 1;
  }
};

TEST_F(ExchangedFolder, IsInThePlaceOfTheOneBeforeWithItsRightsAndHasNothingInIt) {
  ASSERT_TRUE(exchange_memory_folder(spare, place));
  EXPECT_TRUE(stands_at_the_place(spare_number));
  EXPECT_EQ(fs::status(place).permissions(), fs::perms::all | fs::perms::sticky_bit);
  EXPECT_EQ(number_of(spare), place_number);
  EXPECT_TRUE(fs::is_empty(spare));
  EXPECT_TRUE(fs::is_empty(place));
}

TEST_F(ExchangedFolder, HasTheFramesOfADeviceThatGoesOnWithThem) {
  auto device = flows.open(flow, FlowSide::Device).value();
  ASSERT_TRUE(exchange_memory_folder(spare, place));
  EXPECT_TRUE(fs::is_empty(spare));
  EXPECT_TRUE(is_heard(*device)) << "by who comes to the folder of now";
  // The next one of the device comes to it, too, and what both have closed is away.
  device.reset();
  EXPECT_TRUE(fs::is_empty(place));
  device = flows.open(flow, FlowSide::Device).value();
  EXPECT_TRUE(is_heard(*device));
}

TEST_F(ExchangedFolder, GoesAndComesAsOftenAsOneLikes) {
  const auto device = flows.open(flow, FlowSide::Device).value();
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(exchange_memory_folder(spare, place));
    EXPECT_TRUE(stands_at_the_place(i % 2 == 0 ? spare_number : place_number));
    EXPECT_TRUE(is_heard(*device));
  }
}

TEST_F(ExchangedFolder, IsFoundByADeviceThatComesAndGoesAllTheTime) {
  std::atomic<bool> done{false};
  int opened = 0, failed = 0;
  std::thread restless{[&] {
    while (!done) ++(flows.open(flow, FlowSide::Device) ? opened : failed);
  }};
  int exchanged = 0;
  for (int i = 0; i < 2000; ++i) exchanged += exchange_memory_folder(spare, place) ? 1 : 0;
  done = true;
  restless.join();
  EXPECT_GT(exchanged, 1000) << "one that is refused leaves all as it was";
  EXPECT_GT(opened, 0);
  EXPECT_EQ(failed, 0);
  EXPECT_TRUE(fs::is_empty(spare)) << "no device is left where nobody comes";
  EXPECT_TRUE(is_heard(*flows.open(flow, FlowSide::Device).value()));
}

TEST_F(ExchangedFolder, IsNoneWhereWhatStandsThereIsNoFolderOrNothing) {
  fs::remove(place);
  EXPECT_EQ(exchange_memory_folder(spare, place).error().code, ErrorCode::NotFound);
  std::ofstream{place} << "a file";
  EXPECT_EQ(exchange_memory_folder(spare, place).error().code, ErrorCode::Mismatch);
  fs::remove(place);
  fs::create_symlink("/dev/shm", place);
  EXPECT_EQ(exchange_memory_folder(spare, place).error().code, ErrorCode::Mismatch) << "a link would lead elsewhere";
  fs::remove(place);
  EXPECT_EQ(number_of(spare), spare_number);
}

TEST_F(ExchangedFolder, IsRefusedWhereItsProcessHasPutAFolderInTheWayOfFrames) {
  const auto device = flows.open(flow, FlowSide::Device).value();
  fs::create_directory(spare + "/frames");
  EXPECT_EQ(exchange_memory_folder(spare, place).error().code, ErrorCode::Mismatch);
  EXPECT_TRUE(stands_at_the_place(place_number));
  EXPECT_TRUE(is_heard(*device));
}

TEST_F(ExchangedFolder, TellsWhetherASubsystemHasItsFramesOpenAndWhetherSomethingElseIsInIt) {
  EXPECT_FALSE(is_open_by_a_subsystem(place));
  const auto device = flows.open(flow, FlowSide::Device).value();
  EXPECT_FALSE(is_open_by_a_subsystem(place)) << "its device is none";
  {
    const auto subsystem = flows.open(flow, FlowSide::Subsystem).value();
    EXPECT_TRUE(is_open_by_a_subsystem(place));
  }
  EXPECT_FALSE(is_open_by_a_subsystem(place));
  EXPECT_TRUE(holds_frames_at_most(place));
  EXPECT_TRUE(holds_frames_at_most(spare));
  std::ofstream{spare + "/more"} << "more";
  EXPECT_FALSE(holds_frames_at_most(spare));
  EXPECT_FALSE(holds_frames_at_most(spare + "-none"));
}

}  // namespace
}  // namespace hirosco
