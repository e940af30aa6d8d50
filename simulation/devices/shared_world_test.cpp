// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Two devices in one world, and one that has it alone: for whom it stands in a step that a watchdog forgives.
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/devices/simulated_device.hpp"

namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;

constexpr Duration slider_cycle = 1ms;
/// Of a program that starves: longer than the two cycles that it plans from an exchange on, by more than jitter.
constexpr Duration starved_step = 4ms;

/// What moves in a world.
struct Slider {
  double speed_m_s{0};
  double place_m{0};
};
using SharedWorld = std::array<Slider, 2>;

/// Drives one of the two as fast as it is told. Like a part of another device's world it moves nothing itself, unless the world is its own: then
/// all that there is moves with it.
class SliderDevice final : public SimulatedDevice {
 public:
  enum class Has : std::uint8_t { WorldAlone, SharedWorld, PartOfIt };
  SliderDevice(FlowFactory& flows, const char* name, SharedWorld& world, Has has)
      : SimulatedDevice{flows, {Transfer::SharedMemory, name}, {.cycle = slider_cycle}}, world_{world}, has_{has} {}

 private:
  [[nodiscard]] Slider& own() noexcept { return world_[has_ == Has::PartOfIt ? 1 : 0]; }
  void advance(Duration cycle) noexcept override {
    if (has_ == Has::PartOfIt) return;
    for (Slider& each : world_) each.place_m += each.speed_m_s * seconds(cycle);
  }
  [[nodiscard]] bool has_world_alone() const noexcept override { return has_ == Has::WorldAlone; }
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override {
    own().speed_m_s = payload.get<double>();
    return payload.exhausted() ? ok() : fail(ErrorCode::Malformed, "one speed");
  }
  void write_sensors(OctetWriter& payload) noexcept override { payload.put(own().place_m); }
  [[nodiscard]] Result<> do_fault(const Words&) override { return fail(ErrorCode::InvalidArgument, "unknown fault"); }
  [[nodiscard]] std::string do_truth() const override { return "slider=1"; }

  SharedWorld& world_;
  Has has_;
};

/// The subsystem's side of one of them, by hand.
struct SliderCommander {
  SliderCommander(LocalFlows& flows, const char* name)
      : flow{flows.open({Transfer::SharedMemory, name}, FlowSide::Subsystem).value()} {}
  void command(double speed_m_s) {
    std::array<std::byte, 8> payload{};
    OctetWriter{payload, std::endian::little}.put(speed_m_s);
    std::array<std::byte, max_device_frame_octets> buffer;
    const DeviceCommand active{
        .mode = DeviceMode::Active, .epoch = 1, .sequence = ++sequence, .watchdog_us = 5000, .payload = payload};
    ASSERT_TRUE(flow->send(write_command(buffer, active).value()));
  }
  std::unique_ptr<DataFlow> flow;
  std::uint32_t sequence{0};
};

/// Fewer than a watchdog forgives one after the other.
constexpr int starved_steps = 5;
using Has = SliderDevice::Has;

TEST(StarvedDevice, WhoseWorldIsItsOwnHasItStandInTheStepsThatItsWatchdogForgives) {
  LocalFlows flows;
  SharedWorld world{};
  SliderDevice device{flows, "slider", world, Has::WorldAlone};
  ASSERT_TRUE(device.plug());
  SliderCommander commander{flows, "slider"};
  TimePoint now{1s};
  commander.command(1);
  device.step(now);
  const double where_m = world[0].place_m;
  const auto lived = device.cycles();
  for (int i = 0; i < starved_steps; ++i) {
    device.step(now += starved_step);
    ASSERT_TRUE(device.active()) << "its watchdog forgives step " << i;
    ASSERT_EQ(world[0].place_m, where_m) << i;
  }
  EXPECT_EQ(device.cycles(), lived);
  commander.command(1);
  device.step(now += slider_cycle);
  EXPECT_GT(world[0].place_m, where_m) << "it goes on with whoever commands it";
}

/// Whichever of the two is commanded in time, the other one's forgiven steps pass in the world of both.
TEST(StarvedDevice, WhoseWorldIsAnothersTooHasItGoOnInTheStepsThatItsWatchdogForgives) {
  for (const bool whole_starves : {true, false}) {
    LocalFlows flows;
    SharedWorld world{};
    SliderDevice whole{flows, "whole", world, Has::SharedWorld}, part{flows, "part", world, Has::PartOfIt};
    ASSERT_TRUE(whole.plug() && part.plug());
    SliderCommander of_whole{flows, "whole"}, of_part{flows, "part"};
    TimePoint now{1s};
    of_whole.command(1);
    of_part.command(1);
    whole.step(now);
    part.step(now);
    const SliderDevice& starved = whole_starves ? whole : part;
    const auto lived = starved.cycles();
    const double where_m = world[1].place_m;
    for (int i = 0; i < starved_steps; ++i) {
      now += starved_step;
      (whole_starves ? of_part : of_whole).command(1);
      whole.step(now);
      part.step(now);
      ASSERT_TRUE(whole.active() && part.active()) << "the watchdog forgives step " << i;
    }
    // By its own clock it plans two cycles from an exchange on, then one each time.
    EXPECT_EQ(starved.cycles(), lived + starved_steps + 1) << (whole_starves ? "the whole" : "its part");
    EXPECT_GT(world[1].place_m, where_m + 4.5e-3) << "whoever is in it moves on";
  }
}

}  // namespace
}  // namespace hirosco::simulation
