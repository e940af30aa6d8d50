// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/imager/camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/devices/imager/pack.hpp"

namespace hirosco::simulation {
namespace {

constexpr std::size_t all_pixels = std::size_t{sensor_pixels} * sensor_pixels;

TEST(CameraSky, IsTheSameForTheSameShotAndAnotherElsewhere) {
  Sky sky;
  const auto image = [&](const Shot& shot) {
    const auto pixels = sky.expose(shot);
    return std::vector<std::uint8_t>{pixels.begin(), pixels.end()};
  };
  const auto first = image({.exposure_us = 20'000});
  EXPECT_EQ(first.size(), all_pixels);
  EXPECT_EQ(first, image({.exposure_us = 20'000}));
  EXPECT_NE(first, image({.sky = 2, .exposure_us = 20'000}));
  const auto moved = image({.u = 3, .v = -2, .exposure_us = 20'000});
  for (const std::size_t x : {100U, 511U, 900U})
    for (std::size_t y = 10; y < 1000; ++y)
      ASSERT_EQ(moved[(y + 2) * sensor_pixels + x], first[y * sensor_pixels + x + 3]) << x << ", " << y;
  const auto stars = std::ranges::count_if(first, [](std::uint8_t value) { return value > 100; });
  EXPECT_GT(stars, 100);
  EXPECT_LT(stars, 10'000) << "most of it is dark";
}

TEST(CameraSky, BinsToSumsAndReadsWhatIsDarkAsNothing) {
  Sky sky;
  const auto plain = sky.expose({.dark_counts = 20, .shutter = false, .window = {4, 8, 8, 4, 1}});
  EXPECT_EQ(plain.size(), 32u);
  EXPECT_TRUE(std::ranges::all_of(plain, [](std::uint8_t value) { return value == 20; }));
  const auto binned = sky.expose({.dark_counts = 20, .shutter = false, .window = {4, 8, 8, 4, 2}});
  EXPECT_EQ(binned.size(), 8u);
  EXPECT_EQ(binned[0], 80);
  EXPECT_EQ(sky.expose({.dark_counts = 20, .shutter = false, .window = {4, 8, 8, 4, 4}})[0], 255) << "320, cut";
  EXPECT_EQ(sky.expose({.dark_counts = 20, .shutter = false, .threshold = 21, .window = {4, 8, 8, 4, 1}})[0], 0);
  EXPECT_EQ(sky.expose({.dark_counts = 20, .shutter = false, .threshold = 20, .window = {4, 8, 8, 4, 1}})[0], 20);
  EXPECT_FALSE((SensorWindow{1020, 0, 8, 8, 1}.possible()));
  EXPECT_FALSE((SensorWindow{0, 0, 9, 8, 2}.possible()));
}

TEST(Pack, IsWhatItsAuthorsSay) {
  std::array<std::uint8_t, 64> out{};
  const std::vector<std::uint8_t> pixels{0xAA, 0xAA, 0xAA, 0x80, 0x00, 0x2A, 0xAA, 0xAA, 0xAA, 0xAA, 0x80, 0x00,
                                         0x2A, 0x22, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA};
  const std::vector<std::uint8_t> expected{0xFE, 0xAA, 0x02, 0x80, 0x00, 0x2A, 0xFD, 0xAA,
                                           0x03, 0x80, 0x00, 0x2A, 0x22, 0xF7, 0xAA};
  const Packed packed = pack(pixels, out);
  EXPECT_EQ(packed.pixels, pixels.size());
  EXPECT_EQ((std::vector<std::uint8_t>{out.begin(), out.begin() + packed.octets}), expected);
}

/// The camera's own side of the wire, and what the test makes of its packets.
struct CameraTest : ::testing::Test {
  LocalFlows flows;
  FlowAddress command_address{Transfer::SharedMemory, "command"};
  SimulatedDevice::Settings settings{.cycle = std::chrono::milliseconds{5},
                                     .watchdog = std::chrono::milliseconds{500},
                                     .endnode = "COMMAND",
                                     .further = {{.name = "STATUS", .addresses = {{Transfer::SharedMemory, "status"}}},
                                                 {.name = "IMAGE", .addresses = {{Transfer::SharedMemory, "image"}}}}};
  Camera camera{flows, command_address, settings};
  std::map<std::string, std::unique_ptr<DataFlow>> ways;
  TimePoint now{};
  std::uint32_t sequence{0};

  void SetUp() override {
    ASSERT_TRUE(camera.plug());
    for (const char* name : {"command", "status", "image"})
      ways[name] = flows.open({Transfer::SharedMemory, name}, FlowSide::Subsystem).value();
  }
  /// What it answers to this payload at this endnode.
  std::vector<std::byte> ask(const char* endnode, Octets payload) {
    std::array<std::byte, max_device_frame_octets> frame{};
    static_cast<void>(
        ways[endnode]->send(write_command(frame, {DeviceMode::Active, 1, ++sequence, 0, payload}).value()));
    camera.step(now += settings.cycle);
    const auto found = ways[endnode]->receive(frame);
    if (!found || found->flow != Flow::New) return {};
    const auto status = read_status(Octets{frame}.first(found->octets));
    return status ? std::vector<std::byte>{status->payload.begin(), status->payload.end()} : std::vector<std::byte>{};
  }
  struct Answer {
    std::uint32_t image;
    std::uint8_t refused;
  };
  Answer order(std::uint32_t image, float exposure_ms, const SensorWindow& window, std::uint8_t threshold = 8) {
    std::array<std::byte, 18> payload{};
    OctetWriter writer{payload, std::endian::little};
    writer.put(image).put(exposure_ms);
    for (const std::uint32_t part : {window.x, window.y, window.width, window.height})
      writer.put(static_cast<std::uint16_t>(part));
    writer.put(static_cast<std::uint8_t>(window.binning)).put(threshold);
    const auto told = ask("command", payload);
    OctetReader reader{told, std::endian::little};
    const auto number = reader.get<std::uint32_t>();
    return {number, reader.get<std::uint8_t>()};
  }
  struct Packet {
    std::uint32_t image;
    std::uint8_t shutter;
    std::uint16_t packets, packet;
    std::uint32_t start, pixels;
    std::uint16_t octets;
    std::vector<std::byte> coded;
  };
  Packet packet(std::uint32_t image, std::uint16_t wanted) {
    std::array<std::byte, 6> payload{};
    OctetWriter{payload, std::endian::little}.put(image).put(wanted);
    const auto told = ask("image", payload);
    EXPECT_EQ(told.size(), 19 + Camera::packet_octets);
    OctetReader reader{told, std::endian::little};
    Packet found{};
    found.image = reader.get<std::uint32_t>();
    found.shutter = reader.get<std::uint8_t>();
    found.packets = reader.get<std::uint16_t>();
    found.packet = reader.get<std::uint16_t>();
    found.start = reader.get<std::uint32_t>();
    found.pixels = reader.get<std::uint32_t>();
    found.octets = reader.get<std::uint16_t>();
    const Octets coded = reader.get(found.octets);
    found.coded.assign(coded.begin(), coded.end());
    return found;
  }
  /// All packets of an image, unpacked by the words of PackBits' own description.
  std::vector<std::uint8_t> read_out(std::uint32_t image) {
    std::vector<std::uint8_t> pixels;
    for (std::uint16_t number = 0, packets = 1; number < packets; ++number) {
      const Packet found = packet(image, number);
      EXPECT_EQ(found.image, image);
      EXPECT_EQ(found.start, pixels.size());
      packets = found.packets;
      for (std::size_t at = 0; at < found.coded.size();) {
        const auto head = std::to_integer<int>(found.coded[at++]);
        const int count = head < 128 ? head + 1 : 257 - head;
        for (int i = 0; i < count; ++i)
          pixels.push_back(
              std::to_integer<std::uint8_t>(found.coded[at + static_cast<std::size_t>(head < 128 ? i : 0)]));
        at += static_cast<std::size_t>(head < 128 ? count : 1);
      }
    }
    return pixels;
  }
  std::vector<std::uint8_t> made() { return {camera.image().begin(), camera.image().end()}; }
};

TEST_F(CameraTest, HandsOutTheImageOfItsOrderWhenItIsExposed) {
  EXPECT_EQ(order(3, 20, {0, 0, 256, 128, 1}).image, 3u);
  EXPECT_EQ(packet(3, 0).image, 0u) << "it is being exposed";
  for (int i = 0; i < 5; ++i) static_cast<void>(order(3, 20, {0, 0, 256, 128, 1}));
  const auto pixels = read_out(3);
  EXPECT_EQ(pixels.size(), 256u * 128);
  EXPECT_EQ(pixels, made());
  EXPECT_EQ(packet(2, 0).image, 0u) << "of another order";
  EXPECT_EQ(packet(3, 1199).image, 0u);
}

TEST_F(CameraTest, AnImageThatDoesNotPackFitsIntoItsPacketsAllTheSame) {
  ASSERT_TRUE(camera.fault("noise 255"));
  static_cast<void>(order(1, 1, {}, 0));
  static_cast<void>(order(1, 1, {}, 0));
  const auto pixels = read_out(1);
  EXPECT_EQ(pixels, made());
  EXPECT_EQ(pixels.size(), all_pixels);
  EXPECT_LE(packet(1, 0).packets, 1100);
  EXPECT_GE(packet(1, 0).packets, 1084) << "nobody packs noise";
}

TEST_F(CameraTest, StarsPackIntoThirtyASecondAtAMillisecondsCycle) {
  static_cast<void>(order(1, 5, {}));
  static_cast<void>(order(1, 5, {}));
  EXPECT_EQ(read_out(1), made());
  EXPECT_LE(packet(1, 0).packets, 26);
}

TEST_F(CameraTest, LooksElsewhereWhenItIsToldAndWhenItDrifts) {
  ASSERT_TRUE(camera.fault("point 1000 -50"));
  ASSERT_TRUE(camera.fault("drift 200 0"));
  static_cast<void>(order(1, 5, {}));
  EXPECT_EQ(camera.shot().u, 1000);
  for (int i = 0; i < 20; ++i) static_cast<void>(order(1, 5, {}));
  static_cast<void>(order(2, 5, {}));
  EXPECT_NEAR(static_cast<double>(camera.shot().u), 1021, 1) << "a tenth of a second";
  EXPECT_EQ(camera.shot().v, -50);
}

TEST_F(CameraTest, WithAStuckShutterAnImageIsDarkButForItsHotElements) {
  ASSERT_TRUE(camera.fault("shutter stuck"));
  ASSERT_TRUE(camera.fault("hot 5"));
  static_cast<void>(order(1, 5, {}));
  static_cast<void>(order(1, 5, {}));
  EXPECT_EQ(packet(1, 0).shutter, 0);
  EXPECT_EQ(std::ranges::count(made(), 255), 5);
  EXPECT_EQ(std::ranges::count(made(), 0), static_cast<std::ptrdiff_t>(all_pixels - 5));
}

TEST_F(CameraTest, AWarmSensorSeesLightWhereThereIsNone) {
  ASSERT_TRUE(camera.fault("shutter stuck"));
  static_cast<void>(order(1, 1000, {0, 0, 4, 4, 1}, 0));
  EXPECT_EQ(camera.shot().dark_counts, 20u);
  ASSERT_TRUE(camera.fault("temperature 40"));
  static_cast<void>(order(2, 1000, {0, 0, 4, 4, 1}, 0));
  EXPECT_EQ(camera.shot().dark_counts, 80u);
}

TEST_F(CameraTest, RefusesWhatItsSensorDoesNotHave) {
  for (const SensorWindow& window :
       {SensorWindow{1000, 0, 25, 1, 1}, {0, 0, 10, 10, 3}, {0, 0, 0, 1, 1}, {0, 0, 4, 4, 0}}) {
    const Answer answer = order(static_cast<std::uint32_t>(sequence + 1), 1, window);
    EXPECT_EQ(answer.refused, 1) << window.x;
  }
  EXPECT_EQ(order(99, 0, {}).refused, 1);
  EXPECT_EQ(order(100, 1, {}).refused, 0);
}

TEST_F(CameraTest, UnderstandsEachOfItsFaultLinesAndRefusesOthers) {
  for (const FaultLine& each : Camera::fault_lines) EXPECT_TRUE(camera.fault(each.line)) << each.line;
  for (const char* line :
       {"point 1", "drift a b", "temperature", "shutter", "shutter open", "hot -1", "noise 256", "moon 1"})
    EXPECT_FALSE(camera.fault(line)) << line;
}

}  // namespace
}  // namespace hirosco::simulation
