// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "simulation/devices/imager/camera.hpp"
#include "simulation/devices/module.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

/// The stock imager in whole spacecraft on virtual time: an image to ground in parts, images to who is on board, and what eclipse and faults do.
namespace hirosco {
namespace {

using simulation::Camera;
using simulation::SimulatedDevice;

simulation::Plan plan_of(const char* mission) {
  return {.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / mission,
          .subsystems = {},
          .devices = {{"hirosco-sim-imager", simulation::make_device<Camera>}}};
}

/// What ground has of the images: reports of the service IMAGES.
struct Downlink {
  std::vector<std::byte> image;
  std::set<std::uint16_t> parts;
  std::uint32_t descriptions{0};

  void take(const pus::TelemetryView& report) {
    if (report.service() != 210) return;
    if (report.subtype() == 2) ++descriptions;
    if (report.subtype() != 4) return;
    OctetReader reader{report.source_data()};
    static_cast<void>(reader.get<std::uint32_t>());
    const auto part = reader.get<std::uint16_t>();
    const Octets pixels = reader.get(reader.get<std::uint16_t>());
    parts.insert(part);
    image.resize(std::max(image.size(), part * std::size_t{2048} + pixels.size()));
    std::ranges::copy(pixels, image.begin() + part * std::ptrdiff_t{2048});
  }
};

struct Observing : ::testing::Test {
  simulation::Flight flight{plan_of("missions/stargazer/mission.xml")};
  Downlink ground;

  void SetUp() override {
    ASSERT_TRUE(flight.commission()) << flight.story().text();
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) { ground.take(report); };
  }
  Camera& camera() { return flight.device<Camera>("camera"); }
  void fault(const char* device, std::string_view line) {
    ASSERT_TRUE(flight.craft().device(device)->fault(line)) << line;
  }
  simulation::CommandOutcome ask(std::string_view name, const std::vector<Value>& arguments) {
    return flight.craft().command("IMAGER", name, arguments);
  }
  std::vector<std::byte> made() {
    const auto pixels = std::as_bytes(camera().image());
    return {pixels.begin(), pixels.end()};
  }
};

TEST_F(Observing, AnImageReachesGroundOctetByOctetWhateverTheCameraSees) {
  ASSERT_TRUE(ask("ACQUIRE", {20, 1, 0}).completed) << flight.story().text();
  ASSERT_TRUE(ask("SEND_IMAGE", {0, 0, 0}).completed);
  EXPECT_EQ(ground.parts.size(), 512u);
  EXPECT_EQ(ground.descriptions, 1u);
  EXPECT_TRUE(ground.image == made());
  fault("camera", "noise 255");
  ASSERT_TRUE(ask("ACQUIRE", {20, 1, 0}).completed) << "it does not pack, and takes its time";
  ASSERT_TRUE(ask("SEND_IMAGE", {2, 0, 0}).completed);
  EXPECT_TRUE(ground.image == made());
  EXPECT_FALSE(flight.story().has(" medium ")) << flight.story().text();
}

TEST_F(Observing, PartsThatAreMissingAreAskedForAgain) {
  ASSERT_TRUE(ask("SET_WINDOW", {0, 0, 1024, 256, 2}).completed);
  ASSERT_TRUE(ask("ACQUIRE", {20, 1, 0}).completed);
  ASSERT_TRUE(ask("SEND_IMAGE", {1, 2, 5}).completed);
  EXPECT_EQ(ground.parts, (std::set<std::uint16_t>{2, 3, 4, 5, 6}));
  ASSERT_TRUE(ask("SEND_IMAGE", {1, 0, 2}).completed);
  ASSERT_TRUE(ask("SEND_IMAGE", {1, 7, 0}).completed);
  EXPECT_EQ(ground.parts.size(), 32u);
  EXPECT_TRUE(ground.image == made());
}

TEST_F(Observing, ACameraThatIsUnpluggedMakesItSafeAndTakesImagesAgainWhenItIsBack) {
  fault("camera", "unplug");
  ASSERT_TRUE(flight.run_until_state("IMAGER", State::SafeOperational, 2s)) << flight.story().text();
  EXPECT_TRUE(flight.story().has("IMAGER medium CAMERA_COMMAND_LOST")) << flight.story().text();
  flight.craft().run(2s);
  fault("camera", "plug");
  flight.craft().run(1s);
  ASSERT_TRUE(flight.set_state("IMAGER", State::Operational).completed) << flight.story().text();
  EXPECT_TRUE(ask("ACQUIRE", {5, 1, 0}).completed) << flight.story().text() << camera().truth();
}

TEST_F(Observing, InEclipseItObservesByItsBatteryUntilThatIsLowAndThenGivesItsOutletAway) {
  fault("power", "eclipse on");
  flight.craft().run(3s);
  EXPECT_TRUE(ask("ACQUIRE", {5, 1, 0}).completed) << flight.story().text();
  fault("power", "charge 0.39");
  ASSERT_TRUE(flight.run_until_state("IMAGER", State::SafeOperational, 2s)) << flight.story().text();
  EXPECT_TRUE(flight.story().has("POWER medium BUS_LOW"));
  EXPECT_TRUE(ask("SEND_IMAGE", {1, 0, 1}).completed) << "what is on board can be sent";
  flight.craft().run(2s);
  EXPECT_EQ(flight.set_state("IMAGER", State::Operational).failure, pus::FailureCode::PowerShort)
      << flight.story().text();
  fault("power", "charge 0.19");
  ASSERT_TRUE(flight.run_until_state("IMAGER", State::Offline, 5s)) << flight.story().text();
  ASSERT_TRUE(flight.craft().run_until(
      [&] { return flight.craft().device("power")->truth().find("payload_on=0") != std::string::npos; }, 5s));
  fault("power", "heal");
  fault("power", "charge 0.9");
  flight.craft().run(2s);
  ASSERT_TRUE(flight.set_mode("observation").completed) << flight.story().text();
  EXPECT_TRUE(ask("ACQUIRE", {5, 1, 0}).completed);
}

TEST_F(Observing, WhoDiesComesBackAsItWasAndItsNumbersGoOn) {
  ASSERT_TRUE(ask("ACQUIRE", {5, 3, 0}).completed);
  flight.craft().kill("IMAGER");
  flight.craft().run(1s);
  ASSERT_TRUE(flight.run_until_state("IMAGER", State::Operational, 20s)) << flight.story().text();
  EXPECT_FALSE(ask("SEND_IMAGE", {3, 0, 0}).completed) << "it is gone";
  ASSERT_TRUE(ask("ACQUIRE", {5, 1, 0}).completed) << flight.story().text();
  EXPECT_TRUE(ask("SEND_IMAGE", {4, 0, 1}).completed) << "the camera had three";
}

/// 1 Mi pixels, 30 a second, lent to a subsystem that sums them up.
TEST(Watching, ImagesReachWhoIsOnBoardThirtyTimesASecondAsTheCameraMadeThem) {
  simulation::Flight flight{plan_of("missions/stargazer/tests/watched.xml")};
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  auto& camera = flight.device<Camera>("camera");
  std::uint32_t number = 0, whole = 0, overtaken = 0;
  std::uint64_t light = 0, wrong = 0, compared = 0;
  flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
    if (report.apid() != 26 || report.service() != 3) return;
    OctetReader reader{report.source_data()};
    static_cast<void>(reader.get<std::uint16_t>());
    number = reader.get<std::uint32_t>();
    light = reader.get<std::uint64_t>();
    whole = reader.get<std::uint32_t>();
    overtaken = reader.get<std::uint32_t>();
  };
  ASSERT_TRUE(flight.craft().command("IMAGER", "ACQUIRE", {2, 30, 33}).completed) << flight.story().text();
  flight.craft().run(1s);
  EXPECT_EQ(whole, 30u);
  EXPECT_EQ(overtaken, 0u);
  const auto began = flight.craft().now();
  ASSERT_TRUE(flight.craft().command("IMAGER", "ACQUIRE", {2, 90, 33}).completed);
  EXPECT_NEAR(seconds(flight.craft().now() - began), 90 * 0.033, 0.05) << "30 a second";
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(flight.craft().command("IMAGER", "ACQUIRE", {2, 1, 0}).completed);
    flight.craft().run(1s);
    const auto pixels = camera.image();
    ++compared;
    wrong += number != camera.shot().number || light != std::accumulate(pixels.begin(), pixels.end(), std::uint64_t{0})
                 ? 1
                 : 0;
  }
  EXPECT_EQ(compared, 5u);
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(whole, 125u);
  EXPECT_EQ(overtaken, 0u);
}

}  // namespace
}  // namespace hirosco
