// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/imager/imager.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "hirosco/utilities/crc32.hpp"
#include "subsystems/imager/image_store.hpp"
#include "subsystems/imager/sender.hpp"

namespace hirosco {
namespace {

constexpr std::uint8_t images_service = 210, image_report = 2, part_report = 4;
constexpr std::uint16_t image_taken = 2501, series_done = 2502, image_lost = 2503, shutter_stuck = 2504,
                        sensor_hot = 2505;

/// A pixel of image `number`: no two images, and no two parts of one, are alike.
std::uint8_t pixel_of(std::uint32_t number, std::uint32_t at) {
  return static_cast<std::uint8_t>(number * 31 + at + at / 251);
}

/// The test plays the camera: an order is exposed in two cycles, its packets have 900 pixels as they are.
struct ImagerTest : ::testing::Test {
  const std::filesystem::path file{HIROSCO_SOURCE_DIR "/subsystems/imager/imager.xml"};
  std::unique_ptr<Subsystem> imager = make_imager();
  testing::Rig rig{*imager, descriptor::file_system()(file).value()};
  std::map<std::string, std::unique_ptr<DataFlow>> ways;
  std::vector<std::byte> command, ask;  ///< newest of each
  std::uint32_t taken{0}, pixels{0};
  int exposing{0};
  std::uint32_t loses_every{0};  ///< of the answers with packets; 0: none
  std::uint32_t answers{0};
  bool silent{false}, refuses{false}, opens{true}, garbles{false};
  float temperature_c{20};
  std::uint16_t flags{0};
  TimePoint next_loop{};

  ImagerTest() {
    for (const char* name : {"camera-command", "camera-status", "camera-image"})
      ways[name] = std::move(rig.flows.open({Transfer::SharedMemory, name}, FlowSide::Device)).value();
  }

  std::optional<DeviceCommand> hear(const char* way, std::vector<std::byte>& payload) {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = ways[way]->receive(frame);
    if (silent || !found || found->flow != Flow::New) return std::nullopt;
    const auto read = read_command(Octets{frame}.first(found->octets)).value();
    payload.assign(read.payload.begin(), read.payload.end());
    return read;
  }
  void say(const char* way, const DeviceCommand& to, Octets payload) {
    std::array<std::byte, max_device_frame_octets> frame{};
    const DeviceStatus status{.epoch = 1, .sequence = to.sequence, .flags = flags, .payload = payload};
    static_cast<void>(ways[way]->send(write_status(frame, status).value()));
  }
  void exchange() {
    std::array<std::byte, 1002> data{};
    std::vector<std::byte> nothing;
    OctetWriter writer{data, std::endian::little};
    if (const auto heard = hear("camera-command", command)) {
      OctetReader order{command, std::endian::little};
      const auto number = order.get<std::uint32_t>();
      if (number != taken && number != 0) {
        taken = number;
        exposing = 2;
        static_cast<void>(order.get(8));
        const std::uint32_t width = order.get<std::uint16_t>(), height = order.get<std::uint16_t>(),
                            binning = order.get<std::uint8_t>();
        pixels = width / binning * (height / binning);
      }
      writer.put(taken).put(static_cast<std::uint8_t>(refuses ? 1 : 0));
      say("camera-command", *heard, writer.written());
    }
    if (const auto heard = hear("camera-status", nothing)) {
      OctetWriter status{data, std::endian::little};
      status.put(temperature_c).put(std::uint8_t{0});
      say("camera-status", *heard, status.written());
    }
    if (const auto heard = hear("camera-image", ask)) tell_packet(*heard);
    if (exposing > 0) --exposing;
  }
  void tell_packet(const DeviceCommand& heard) {
    OctetReader reader{ask, std::endian::little};
    const auto image = reader.get<std::uint32_t>();
    const auto packet = reader.get<std::uint16_t>();
    const std::uint32_t start = packet * 900U, count = start < pixels ? std::min(pixels - start, 900U) : 0;
    const bool there = image == taken && image != 0 && exposing == 0 && count > 0;
    std::array<std::byte, 1002> data{};
    OctetWriter writer{data, std::endian::little};
    writer.put(there ? image : 0U).put(static_cast<std::uint8_t>(opens ? 1 : 0));
    writer.put(static_cast<std::uint16_t>((pixels + 899) / 900)).put(packet).put(start).put(count);
    std::vector<std::byte> coded;
    for (std::uint32_t at = 0; at < count; at += 128) {
      const std::uint32_t run = std::min(128U, count - at);
      coded.push_back(static_cast<std::byte>(run - 1));
      for (std::uint32_t i = 0; i < run; ++i) coded.push_back(static_cast<std::byte>(pixel_of(image, start + at + i)));
    }
    writer.put(static_cast<std::uint16_t>(garbles ? coded.size() - 1 : coded.size()));
    coded.resize(968);
    writer.put(Octets{coded});
    if (there && loses_every != 0 && ++answers % loses_every == 0) return;
    say("camera-image", heard, writer.written());
  }
  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      const TimePoint before = rig.clock.now();
      rig.cycle();
      if (rig.clock.now() == before) rig.advance(5ms);  // no configuration, no cycle
      exchange();
      if (rig.clock.now() >= next_loop) next_loop = rig.own_loop(0, rig.clock.now());
      rig.service();
    }
  }
  void bring_to(State wanted) {
    rig.bring_to(State::PreOperational, 1);
    cycle(25);
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto request = rig.set_state(state);
      cycle(5);
      ASSERT_EQ(rig.outcome(request), "1 3 7") << to_text(state) << ::testing::PrintToString(rig.explanations);
      if (state == wanted) return;
    }
  }
  std::string finish(const testing::Sent& request, int most = 5000) {
    while (rig.outcome(request).find_first_of("48") == std::string::npos &&
           rig.outcome(request).find('7') == std::string::npos && most-- > 0)
      cycle();
    return rig.outcome(request);
  }
  std::string acquire(double exposure_ms = 5, double images = 1, double period_ms = 0) {
    return finish(rig.call("ACQUIRE", {exposure_ms, images, period_ms}));
  }
  void window(double width, double height) {
    ASSERT_EQ(finish(rig.call("SET_WINDOW", {0, 0, width, height, 1})), "1 3 7");
  }
  testing::Sent send_image(std::uint32_t number, std::uint16_t first = 0, std::uint16_t count = 0) {
    std::vector<std::byte> data(8);
    OctetWriter{data}.put(number).put(first).put(count);
    return rig.send(images_service, 3, data);
  }
  std::vector<std::vector<std::byte>> told(std::uint8_t subtype) {
    std::vector<std::vector<std::byte>> found;
    for (const auto& report : rig.telemetry)
      if (report.service == images_service && report.subtype == subtype) found.push_back(report.data);
    return found;
  }
  /// Numbers of the parts that came, and their pixels side by side.
  std::vector<std::uint16_t> parts() {
    std::vector<std::uint16_t> numbers;
    for (const auto& part : told(part_report))
      numbers.push_back(OctetReader{Octets{part}.subspan(4)}.get<std::uint16_t>());
    return numbers;
  }
  std::vector<std::byte> put_together() {
    std::vector<std::byte> image;
    for (const auto& part : told(part_report)) {
      OctetReader reader{Octets{part}.subspan(6)};
      const auto octets = reader.get<std::uint16_t>();
      const Octets pixels_of_part = reader.get(octets);
      image.insert(image.end(), pixels_of_part.begin(), pixels_of_part.end());
    }
    return image;
  }
  static std::vector<std::byte> expected(std::uint32_t number, std::uint32_t count) {
    std::vector<std::byte> image;
    for (std::uint32_t at = 0; at < count; ++at) image.push_back(static_cast<std::byte>(pixel_of(number, at)));
    return image;
  }
};

TEST_F(ImagerTest, TakesAnImageAndSendsItInPartsWithTheChecksumOfTheWhole) {
  bring_to(State::Operational);
  window(100, 50);
  EXPECT_EQ(acquire(), "1 3 7");
  EXPECT_EQ(rig.heard(image_taken), 1);
  EXPECT_EQ(rig.heard(series_done), 1);
  rig.forget_telemetry();
  const auto request = send_image(0);
  EXPECT_EQ(finish(request), "1 3 7");
  ASSERT_EQ(told(image_report).size(), 1u);
  EXPECT_EQ(parts(), (std::vector<std::uint16_t>{0, 1, 2}));
  EXPECT_EQ(put_together(), expected(1, 5000));
  const std::vector<std::byte> description = told(image_report)[0];
  OctetReader about{description};
  EXPECT_EQ(about.get<std::uint32_t>(), 1u);
  static_cast<void>(about.get(4 + 4 + 4 + 1 + 8 + 1));
  EXPECT_EQ(about.get<std::uint16_t>(), 100);
  EXPECT_EQ(about.get<std::uint16_t>(), 50);
  EXPECT_EQ(about.get<std::uint32_t>(), 5000u);
  EXPECT_EQ(about.get<std::uint16_t>(), 3);
  EXPECT_EQ(about.get<std::uint32_t>(), crc32(expected(1, 5000)));
}

TEST_F(ImagerTest, SendsThePartsThatAreAskedForAndRefusesOthers) {
  bring_to(State::Operational);
  window(128, 128);
  ASSERT_EQ(acquire(), "1 3 7");
  rig.forget_telemetry();
  EXPECT_EQ(finish(send_image(1, 3, 2)), "1 3 7");
  EXPECT_EQ(parts(), (std::vector<std::uint16_t>{3, 4}));
  EXPECT_TRUE(finish(send_image(1, 8, 0)).starts_with("1 4:8005")) << "there are 0 to 7";
  EXPECT_TRUE(finish(send_image(1, 3, 6)).starts_with("1 4:8005"));
  EXPECT_TRUE(finish(send_image(2)).starts_with("1 4:8004"));
}

TEST_F(ImagerTest, SendsNoFasterThanItMay) {
  bring_to(State::Operational);
  window(512, 256);
  ASSERT_EQ(acquire(), "1 3 7");
  const TimePoint begun = rig.clock.now();
  EXPECT_EQ(finish(send_image(0)), "1 3 7");
  // 128 KiB at 250,000 a second, a tenth of a second of it at once.
  EXPECT_NEAR(seconds(rig.clock.now() - begun), 131'072.0 / 250'000 - 0.1, 0.06);
}

TEST_F(ImagerTest, WhatIsBeingSentStaysWhileOthersAreTaken) {
  bring_to(State::Operational);
  window(1024, 256);
  ASSERT_EQ(acquire(), "1 3 7");
  rig.forget_telemetry();
  const auto request = send_image(1);
  cycle(10);
  window(32, 32);
  EXPECT_EQ(acquire(5, 6), "1 3 7");
  EXPECT_EQ(finish(request), "1 3 7");
  EXPECT_EQ(put_together(), expected(1, 1024 * 256));
  ASSERT_EQ(acquire(), "1 3 7");
  EXPECT_TRUE(finish(send_image(1)).starts_with("1 4:8004")) << "it was the oldest, and nobody held it";
}

TEST_F(ImagerTest, RequestsWaitForEachOtherEightOfThemAndEndWithStopSending) {
  bring_to(State::Operational);
  window(1024, 64);
  ASSERT_EQ(acquire(), "1 3 7");
  std::vector<testing::Sent> requests;
  for (int i = 0; i < 8; ++i) {
    requests.push_back(send_image(0));
    cycle(4);
  }
  EXPECT_TRUE(finish(send_image(0)).starts_with("1 4:8006"));
  const auto stop = rig.send(images_service, 5, {});
  EXPECT_EQ(finish(stop), "1 3 7");
  EXPECT_EQ(finish(requests[0]), "1 3 7") << "it was done before";
  EXPECT_TRUE(finish(requests[7]).starts_with("1 3 8"));
  rig.forget_telemetry();
  cycle(20);
  EXPECT_TRUE(parts().empty());
}

TEST_F(ImagerTest, GivesWhatItHasInEveryStateAndForgetsRequestsWithTheirConfiguration) {
  bring_to(State::Operational);
  window(1024, 256);
  ASSERT_EQ(acquire(), "1 3 7");
  for (const State state : {State::SafeOperational, State::PreOperational}) {
    const auto down = rig.set_state(state);
    ASSERT_EQ(finish(down), "1 3 7");
  }
  const auto request = send_image(0);
  cycle(10);
  ASSERT_EQ(rig.outcome(request), "1 3");
  const auto configure = rig.configure(1);
  ASSERT_EQ(finish(configure), "1 3 7");
  EXPECT_TRUE(finish(request).starts_with("1 3 8"));
  rig.forget_telemetry();
  cycle(20);
  EXPECT_TRUE(parts().empty());
  EXPECT_EQ(finish(send_image(0)), "1 3 7");
}

TEST_F(ImagerTest, LostAnswersOfTheCameraCostCyclesAndNoImage) {
  bring_to(State::Operational);
  window(256, 128);
  loses_every = 3;
  ASSERT_EQ(acquire(), "1 3 7");
  rig.forget_telemetry();
  EXPECT_EQ(finish(send_image(0)), "1 3 7");
  EXPECT_EQ(put_together(), expected(1, 256 * 128));
  EXPECT_EQ(rig.heard(image_lost), 0);
}

TEST_F(ImagerTest, OneImageAtATimeInItsWindowAndInOperationalOnly) {
  bring_to(State::SafeOperational);
  EXPECT_EQ(acquire(), "1 4:000a04") << "wrong state";
  const auto up = rig.set_state(State::Operational);
  ASSERT_EQ(finish(up), "1 3 7");
  EXPECT_TRUE(finish(rig.call("SET_WINDOW", {1000, 0, 25, 10, 1})).starts_with("1 4:8003"));
  EXPECT_TRUE(finish(rig.call("SET_WINDOW", {0, 0, 25, 10, 2})).starts_with("1 4:8003"));
  const auto endless = rig.call("ACQUIRE", {5, 0, 0});
  cycle(10);
  EXPECT_TRUE(acquire().starts_with("1 4:8001"));
  EXPECT_EQ(finish(rig.call("STOP")), "1 3 7");
  EXPECT_TRUE(finish(endless).starts_with("1 3 8"));
  const auto left = rig.call("ACQUIRE", {5, 0, 0});
  cycle(10);
  ASSERT_EQ(rig.outcome(left), "1 3");
  const auto down = rig.set_state(State::SafeOperational);
  ASSERT_EQ(finish(down), "1 3 7");
  EXPECT_TRUE(finish(left).starts_with("1 3 8")) << "not Operational any more";
}

TEST_F(ImagerTest, ASeriesKeepsItsPeriodAndGoesOnBehindAnImageThatIsLost) {
  bring_to(State::Operational);
  window(32, 32);
  const TimePoint begun = rig.clock.now();
  ASSERT_EQ(acquire(5, 4, 200), "1 3 7");
  EXPECT_NEAR(seconds(rig.clock.now() - begun), 0.6, 0.05);
  garbles = true;
  const auto request = rig.call("ACQUIRE", {5, 2, 0});
  while (rig.heard(image_lost) == 0 && rig.clock.now() < begun + 10s) cycle();
  garbles = false;
  EXPECT_EQ(finish(request), "1 3 7");
  EXPECT_EQ(rig.heard(image_taken), 5);
  refuses = true;
  EXPECT_TRUE(acquire().starts_with("1 3 8"));
  EXPECT_EQ(rig.heard(image_lost), 2);
}

TEST_F(ImagerTest, ACameraThatIsGoneEndsTheSeriesAndTakesNoOrder) {
  bring_to(State::Operational);
  const auto request = rig.call("ACQUIRE", {5, 0, 0});
  cycle(10);
  silent = true;
  EXPECT_TRUE(finish(request).starts_with("1 3 8"));
  EXPECT_TRUE(acquire().starts_with("1 4:8002"));
}

TEST_F(ImagerTest, ACameraWhoseWatchdogHasLetGoTakesNoOrder) {
  bring_to(State::Operational);
  flags = device_flag::watchdog_tripped;
  cycle(2);
  EXPECT_TRUE(acquire().starts_with("1 4:8002"));
  flags = 0;
  cycle(2);
  EXPECT_EQ(acquire(), "1 3 7");
}

TEST_F(ImagerTest, NumbersGoOnBehindThoseThatTheCameraHasHad) {
  taken = 41;
  bring_to(State::Operational);
  window(32, 32);
  ASSERT_EQ(acquire(), "1 3 7");
  rig.forget_telemetry();
  EXPECT_EQ(finish(send_image(42)), "1 3 7");
}

TEST_F(ImagerTest, TellsAStuckShutterAndAHotSensorOnceEach) {
  bring_to(State::Operational);
  window(32, 32);
  opens = false;
  ASSERT_EQ(acquire(5, 3), "1 3 7");
  EXPECT_EQ(rig.heard(shutter_stuck), 1);
  temperature_c = 41;
  cycle(60);
  EXPECT_EQ(rig.heard(sensor_hot), 1);
  temperature_c = 39;
  cycle(60);
  temperature_c = 41;
  cycle(60);
  EXPECT_EQ(rig.heard(sensor_hot), 1) << "it has not cooled down";
  temperature_c = 37;
  cycle(60);
  temperature_c = 41;
  cycle(60);
  EXPECT_EQ(rig.heard(sensor_hot), 2);
}

}  // namespace
}  // namespace hirosco
