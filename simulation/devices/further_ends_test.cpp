// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// A device with two endnodes that move something: what is said at one moves, stops and inhibits nothing at the other.
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/devices/simulated_device.hpp"

namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;

constexpr Duration turret_cycle = 1ms;
constexpr std::uint32_t turret_watchdog_us = 5000;

/// Turns by what comes at its first endnode and tilts by what comes at its second, as fast as each is told; a controlled stop of the tilt halves its
/// speed in each cycle.
class Turret final : public SimulatedDevice {
 public:
  Turret(FlowFactory& flows, const Settings& settings)
      : SimulatedDevice{flows, {Transfer::SharedMemory, "turn"}, settings} {}
  double turned_rad{0}, tilted_rad{0};
  double turn_rad_s{0}, tilt_rad_s{0};
  using SimulatedDevice::output_at;

 private:
  void advance(Duration cycle) noexcept override {
    if (output() == DeviceOutput::Active) turned_rad += turn_rad_s * seconds(cycle);
    if (output_at("TILT") == DeviceOutput::Stopping) tilt_rad_s /= 2;
    else if (output_at("TILT") != DeviceOutput::Active) tilt_rad_s = 0;
    tilted_rad += tilt_rad_s * seconds(cycle);
  }
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override { return read(payload, turn_rad_s); }
  [[nodiscard]] Result<> take_at(std::string_view endnode, OctetReader payload) noexcept override {
    return endnode == "TILT" ? read(payload, tilt_rad_s) : SimulatedDevice::take_at(endnode, payload);
  }
  [[nodiscard]] static Result<> read(OctetReader payload, double& to) noexcept {
    const auto value = payload.get<double>();
    if (!payload.exhausted()) return fail(ErrorCode::Malformed, "one speed");
    to = value;
    return ok();
  }
  void write_sensors(OctetWriter& payload) noexcept override { payload.put(turned_rad); }
  void write_sensors_at(std::string_view endnode, OctetWriter& payload) noexcept override {
    if (endnode == "TILT") payload.put(tilted_rad);
    else payload.put(std::uint8_t{20});
  }
  [[nodiscard]] bool can_at(std::string_view endnode, Stop stop) const noexcept override {
    return endnode == "TILT" && stop != Stop::Hold;
  }
  [[nodiscard]] Result<> do_fault(const Words&) override { return fail(ErrorCode::InvalidArgument, "unknown fault"); }
  [[nodiscard]] std::string do_truth() const override { return "turret=1"; }
};

SimulatedDevice::Settings turret_settings() {
  return {.cycle = turret_cycle,
          .actuator = true,
          .endnode = "TURN",
          .further = {{.name = "TILT",
                       .addresses = {{Transfer::SharedMemory, "tilt"}},
                       .actuator = FurtherActuator{.stop = DeviceStop::Controlled, .stop_within = 10ms}},
                      {.name = "HEAT", .addresses = {{Transfer::SharedMemory, "heat"}}}}};
}

/// The subsystem's side of it, by hand.
struct TurretTest : ::testing::Test {
  struct Way {
    std::unique_ptr<DataFlow> flow;
    std::uint32_t sequence{0};
  };
  LocalFlows flows;
  std::optional<Turret> turret;
  Way turn, tilt, heat;
  TimePoint now{1s};

  void make(const SimulatedDevice::Settings& settings = turret_settings()) {
    turret.emplace(flows, settings);
    ASSERT_TRUE(turret->plug());
    const auto open = [&](const char* name) {
      return flows.open({Transfer::SharedMemory, name}, FlowSide::Subsystem).value();
    };
    turn.flow = open("turn");
    tilt.flow = open("tilt");
    heat.flow = open("heat");
    // Whoever begins is let go until it has been told to be off: each of the two for itself (docs/adr/0149).
    command(turn, DeviceMode::Off);
    command(tilt, DeviceMode::Off);
    step();
  }
  void command(Way& way, DeviceMode mode, double speed_rad_s = 0, std::uint32_t epoch = 1) {
    std::array<std::byte, 8> payload{};
    OctetWriter{payload, std::endian::little}.put(speed_rad_s);
    std::array<std::byte, max_device_frame_octets> buffer;
    const DeviceCommand said{.mode = mode,
                             .epoch = epoch,
                             .sequence = ++way.sequence,
                             .watchdog_us = turret_watchdog_us,
                             .payload = payload};
    ASSERT_TRUE(way.flow->send(write_command(buffer, said).value()));
  }
  void step() { turret->step(now += turret_cycle); }
  struct Answer {
    std::uint32_t sequence;
    std::uint16_t flags;
    std::size_t octets;
  };
  static std::optional<Answer> answer(Way& way) {
    std::array<std::byte, max_device_frame_octets> buffer;
    const auto received = way.flow->receive(buffer);
    if (!received || received->flow != Flow::New) return std::nullopt;
    const auto status = read_status(Octets{buffer}.first(received->octets));
    if (!status) return std::nullopt;
    return Answer{status->sequence, status->flags, status->payload.size()};
  }
};

TEST_F(TurretTest, MovesByWhatIsSaidAtEachOfItsEndnodesAndAnswersAtTheSameOne) {
  make();
  command(turn, DeviceMode::Active, 1);
  step();
  EXPECT_NEAR(turret->turned_rad, 0.001, 1e-12);
  EXPECT_EQ(turret->tilted_rad, 0);
  command(turn, DeviceMode::Active, 1);
  command(tilt, DeviceMode::Active, -2);
  step();
  EXPECT_NEAR(turret->turned_rad, 0.002, 1e-12);
  EXPECT_NEAR(turret->tilted_rad, -0.002, 1e-12);
  EXPECT_TRUE(turret->active());
  EXPECT_EQ(turret->output_at("TILT"), DeviceOutput::Active);
  const auto told = answer(tilt);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->sequence, tilt.sequence);
  EXPECT_EQ(told->octets, 8u);
  step();
  EXPECT_FALSE(answer(tilt)) << "each is answered once";
  std::array<std::byte, max_device_frame_octets> buffer;
  ASSERT_TRUE(heat.flow->send(write_command(buffer, {DeviceMode::Active, 1, 1, 0, {}}).value()));
  step();
  const auto measured = answer(heat);
  ASSERT_TRUE(measured);
  EXPECT_EQ(measured->octets, 1u) << "one without an actuator is as it was";
}

TEST_F(TurretTest, IsLetGoByTheSilenceOfWhoeverCommandsThatEndnodeAndOfNobodyElse) {
  make();
  command(turn, DeviceMode::Active, 1);
  command(tilt, DeviceMode::Active, 1);
  step();
  for (int i = 0; i < 6; ++i) {
    command(turn, DeviceMode::Active, 1);
    step();
  }
  EXPECT_TRUE(turret->active());
  EXPECT_EQ(turret->output_at("TILT"), DeviceOutput::Stopping) << "its declared stop";
  EXPECT_EQ(turret->flags() & device_flag::watchdog_tripped, 0);
  for (int i = 0; i < 12; ++i) {
    command(turn, DeviceMode::Active, 1);
    step();
  }
  EXPECT_EQ(turret->output_at("TILT"), DeviceOutput::Holding);
  EXPECT_EQ(turret->tilt_rad_s, 0);
  command(turn, DeviceMode::Active, 1);
  command(tilt, DeviceMode::Active, 1);
  step();
  EXPECT_NE(turret->output_at("TILT"), DeviceOutput::Active) << "latched until a higher epoch";
  const auto told = answer(tilt);
  ASSERT_TRUE(told);
  EXPECT_NE(told->flags & device_flag::watchdog_tripped, 0);
  command(tilt, DeviceMode::Active, 1, 2);
  step();
  EXPECT_EQ(turret->output_at("TILT"), DeviceOutput::Active);
  const double turned_rad = turret->turned_rad;
  for (int i = 0; i < 8; ++i) {
    command(tilt, DeviceMode::Active, 1, 2);
    step();
  }
  EXPECT_FALSE(turret->active()) << "and the other way round";
  EXPECT_EQ(turret->output_at("TILT"), DeviceOutput::Active);
  EXPECT_LT(turret->turned_rad, turned_rad + 0.008);
  EXPECT_TRUE(turret->drives());
}

TEST_F(TurretTest, RefusesAnOldEpochWhereItWasSaidAndTellsItThere) {
  make();
  command(tilt, DeviceMode::Active, 1, 7);
  step();
  static_cast<void>(answer(tilt));
  command(tilt, DeviceMode::Active, 5, 6);
  command(turn, DeviceMode::Active, 1, 6);
  step();
  auto told = answer(tilt);
  ASSERT_TRUE(told) << "docs/guide/your_device.md, duty 2";
  EXPECT_NE(told->flags & device_flag::old_epoch_refused, 0);
  EXPECT_EQ(told->sequence, tilt.sequence - 1) << "of the last one that counts";
  EXPECT_EQ(turret->tilt_rad_s, 1);
  EXPECT_TRUE(turret->active()) << "an epoch of one is none of the other";
  EXPECT_EQ(turret->flags() & device_flag::old_epoch_refused, 0) << "and nothing that is told there";
  command(tilt, DeviceMode::Off, 0, 7);
  step();
  told = answer(tilt);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->flags & device_flag::old_epoch_refused, 0);
  EXPECT_EQ(told->sequence, tilt.sequence);
}

TEST_F(TurretTest, WhoBeginsIsLetGoAtEachOfThem) {
  make();
  ASSERT_TRUE(turret->fault("reboot"));
  command(turn, DeviceMode::Off);
  command(tilt, DeviceMode::Active, 1);
  step();
  EXPECT_NE(turret->output_at("TILT"), DeviceOutput::Active);
  command(turn, DeviceMode::Active, 1);
  command(tilt, DeviceMode::Active, 1, 2);
  step();
  EXPECT_TRUE(turret->active());
  EXPECT_EQ(turret->output_at("TILT"), DeviceOutput::Active);
}

TEST_F(TurretTest, HasASecondInhibitForEachOfThemAlone) {
  auto settings = turret_settings();
  settings.further[0].actuator->enable = FlowAddress{Transfer::SharedMemory, "tilt.enable"};
  make(settings);
  const auto inhibit = flows.open({Transfer::SharedMemory, "tilt.enable"}, FlowSide::Subsystem).value();
  std::uint32_t sequence = 0;
  const auto enable = [&](std::uint8_t enabled) {
    std::array<std::byte, enable_frame_octets> buffer;
    const EnableCommand said{.enabled = enabled, .epoch = 1, .sequence = ++sequence};
    ASSERT_TRUE(inhibit->send(write_enable_command(buffer, said).value()));
  };
  const auto both = [&] {
    command(turn, DeviceMode::Active, 1);
    command(tilt, DeviceMode::Active, 1);
    step();
  };
  both();
  EXPECT_TRUE(turret->active());
  EXPECT_NE(turret->output_at("TILT"), DeviceOutput::Active) << "nobody has let it";
  enable(1);
  command(tilt, DeviceMode::Off);
  step();
  both();
  EXPECT_EQ(turret->output_at("TILT"), DeviceOutput::Active);
  enable(0);
  both();
  EXPECT_TRUE(turret->active());
  EXPECT_EQ(turret->output_at("TILT"), DeviceOutput::Stopping);
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto received = inhibit->receive(buffer);
  ASSERT_TRUE(received && received->flow == Flow::New);
  const auto told = read_enable_status(Octets{buffer}.first(received->octets));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->output, DeviceOutput::Stopping);
  EXPECT_EQ(told->epoch, 1u);
}

TEST_F(TurretTest, CountsADamagedCommandAndWhatItDoesNotTake) {
  make();
  std::array<std::byte, max_device_frame_octets> buffer;
  const std::array<std::byte, 3> short_payload{};
  ASSERT_TRUE(tilt.flow->send(
      write_command(buffer, {DeviceMode::Active, 1, ++tilt.sequence, turret_watchdog_us, short_payload}).value()));
  step();
  EXPECT_EQ(turret->damaged_commands(), 1u);
  EXPECT_NE(turret->output_at("TILT"), DeviceOutput::Active);
}

TEST_F(TurretTest, OneThatHasNoMotorsThereOrNoSuchStopOfThemIsNotPluggedIn) {
  auto settings = turret_settings();
  settings.further[0].actuator->stop = DeviceStop::Hold;
  EXPECT_EQ(Turret(flows, settings).plug().error().code, ErrorCode::InvalidArgument);
  settings = turret_settings();
  settings.further[1].actuator = FurtherActuator{};
  EXPECT_EQ(Turret(flows, settings).plug().error().code, ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace hirosco::simulation
