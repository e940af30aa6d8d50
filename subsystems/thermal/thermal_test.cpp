// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/thermal/thermal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

namespace hirosco {
namespace {

constexpr std::uint8_t by_set_points = 1, survival = 2;
constexpr std::uint16_t temperature_out = 2401, over_temperature = 2402, sensor_doubted = 2403, power_short = 2404,
                        heaters_differ = 2405, set_point_reached = 2406;
constexpr std::size_t zones = 12;
constexpr float heater_w = 10;

/// The test plays the unit: what each zone says, and heaters that do as they are told.
struct ThermalTest : ::testing::Test {
  const std::filesystem::path file{HIROSCO_SOURCE_DIR "/subsystems/thermal/thermal.xml"};
  std::unique_ptr<Subsystem> thermal = make_thermal();
  testing::Rig rig{*thermal, descriptor::file_system()(file).value()};
  std::unique_ptr<DataFlow> unit =
      std::move(rig.flows.open({Transfer::SharedMemory, "thermal-unit"}, FlowSide::Device)).value();
  std::array<float, zones> t_c{};
  std::array<std::uint8_t, zones> on{}, line{};
  std::array<int, zones> on_cycles{};
  std::uint8_t own{0};
  float stuck_w{0};  ///< drawn by a switch that does not open
  float most_drawn_w{0};
  bool dithers{true};

  ThermalTest() { t_c.fill(20); }

  void exchange() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = unit->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    OctetReader reader{command.payload, std::endian::little};
    for (auto& each : on) each = reader.get<std::uint8_t>();
    for (auto& each : line) each = reader.get<std::uint8_t>();
    own = reader.get<std::uint8_t>();
    ASSERT_TRUE(reader.exhausted());
    float drawn_w = stuck_w;
    for (std::size_t i = 0; i < zones; ++i) {
      on_cycles[i] += on[i];
      if (on[i] != 0 && line[i] != 0) drawn_w += heater_w;
    }
    most_drawn_w = std::max(most_drawn_w, drawn_w);
    std::array<std::byte, max_device_payload_octets> data{};
    OctetWriter writer{data, std::endian::little};
    for (float& each : t_c) writer.put(each += dithers ? (command.sequence % 2 == 0 ? 0.001F : -0.001F) : 0);
    writer.put(drawn_w);
    static_cast<void>(unit->send(
        write_status(frame, {.epoch = 1, .sequence = command.sequence, .payload = writer.written()}).value()));
  }
  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      exchange();
    }
    rig.service();
  }
  void operate(std::uint8_t configuration, State to = State::Operational) {
    rig.bring_to(State::PreOperational, configuration);
    cycle(5);
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto request = rig.set_state(state);
      cycle(5);
      ASSERT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
      if (state == to) return;
    }
  }
  std::string call(std::string_view function, std::initializer_list<double> arguments) {
    const auto request = rig.call(function, arguments);
    cycle(2);
    return rig.outcome(request);
  }
  void forget() {
    on_cycles.fill(0);
    most_drawn_w = 0;
    rig.forget_telemetry();
  }
};

TEST_F(ThermalTest, TheUnitKeepsItsZonesUntilSafeOperational) {
  rig.bring_to(State::PreOperational, by_set_points);
  cycle(3);
  EXPECT_EQ(own, 1);
  EXPECT_EQ(std::ranges::count(on, 1), 0);
  EXPECT_EQ(std::ranges::count(line, 1), 12);
}

TEST_F(ThermalTest, SafeOperationalKeepsWhatSurvivesAndOperationalItsSetPoints) {
  t_c.fill(17.5);
  operate(by_set_points, State::SafeOperational);
  forget();
  cycle(100);
  EXPECT_EQ(own, 0);
  EXPECT_EQ(std::reduce(on_cycles.begin(), on_cycles.end()), 0) << "that is no danger";
  const auto request = rig.set_state(State::Operational);
  cycle(3);
  EXPECT_EQ(rig.outcome(request), "1 3 7");
  forget();
  cycle(100);
  EXPECT_NEAR(on_cycles[0], 50, 3) << "2.5 K lack, a fifth for each";
  EXPECT_LE(most_drawn_w, 60);
}

TEST_F(ThermalTest, SurvivalHeatsWhoIsTooColdAloneAndOnHalfOfThePower) {
  t_c.fill(-12);
  operate(survival);
  forget();
  cycle(100);
  EXPECT_LE(most_drawn_w, 30);
  EXPECT_EQ(on_cycles[0], 100);
  EXPECT_EQ(on_cycles[2], 100) << "the first three in rank";
  EXPECT_EQ(on_cycles[3], 0);
  EXPECT_EQ(rig.heard(temperature_out), 0) << "2 K below is not out yet";
}

TEST_F(ThermalTest, TellsWhoHadLessThanItsShareForAMinute) {
  t_c.fill(-12);
  operate(survival);
  cycle(100);
  EXPECT_EQ(rig.heard(power_short), 0);
  cycle(600);
  EXPECT_EQ(rig.heard(power_short), 9) << "nine of twelve";
}

TEST_F(ThermalTest, WhoIsColderThanItSurvivesComesFirst) {
  t_c.fill(5);  // all want all of the time
  t_c[11] = -11;
  operate(by_set_points);
  forget();
  cycle(100);
  EXPECT_EQ(on_cycles[11], 100) << "the last in rank";
  EXPECT_EQ(on_cycles[5], 0) << "who gave way";
  EXPECT_EQ(on_cycles[4], 100);
  EXPECT_LE(most_drawn_w, 60);
}

TEST_F(ThermalTest, RefusesASetPointThatIsTooHotOrTooColdAndSaysWhatWouldDo) {
  operate(by_set_points);
  EXPECT_EQ(call("SET_POINT", {3, 30}), "1 3 7");
  EXPECT_TRUE(call("SET_POINT", {3, 36}).starts_with("1 4:8001"));
  EXPECT_TRUE(call("SET_POINT", {3, -11}).starts_with("1 4:8002"));
  forget();
  t_c.fill(20);
  cycle(20);
  EXPECT_GT(on_cycles[3], 15) << "30 degC are wanted there still";
}

TEST_F(ThermalTest, TellsOnceThatASetPointIsReached) {
  operate(by_set_points);
  cycle(110);
  EXPECT_EQ(rig.heard(set_point_reached), 12);
  EXPECT_EQ(call("SET_POINT", {0, 20.2}), "1 3 7");
  cycle(110);
  EXPECT_EQ(rig.heard(set_point_reached), 13);
  cycle(200);
  EXPECT_EQ(rig.heard(set_point_reached), 13);
}

TEST_F(ThermalTest, ASensorThatSaysNothingSensibleCostsItsZoneTheLawAndNothingElse) {
  t_c.fill(19);
  operate(by_set_points);
  t_c[2] = -273.15F;
  cycle(5);
  EXPECT_EQ(rig.heard(sensor_doubted), 1);
  forget();
  cycle(100);
  EXPECT_NEAR(on_cycles[2], 30, 2) << "its safe share";
  EXPECT_EQ(rig.heard(sensor_doubted), 0);
  EXPECT_NE(call("TRUST_SENSOR", {2}).find(":8004"), std::string::npos);
  t_c[2] = 25;
  cycle(3);
  EXPECT_EQ(call("TRUST_SENSOR", {2}), "1 3 7");
  forget();
  cycle(100);
  EXPECT_EQ(on_cycles[2], 0) << "the law again";
}

TEST_F(ThermalTest, ASensorThatSaysTheSameForAMinuteIsStuck) {
  dithers = false;
  operate(by_set_points);
  cycle(580);
  EXPECT_EQ(rig.heard(sensor_doubted), 0);
  cycle(100);
  EXPECT_EQ(rig.heard(sensor_doubted), 12);
}

TEST_F(ThermalTest, TheCutOutTakesTheLineInEveryStateWhateverTheLawSays) {
  rig.bring_to(State::PreOperational, by_set_points);
  t_c.fill(20);
  cycle(5);
  t_c[4] = 46;
  cycle(5);
  EXPECT_EQ(rig.heard(over_temperature), 1) << "its sensor jumped as well, and is doubted";
  EXPECT_EQ(line[4], 0);
  EXPECT_EQ(line[5], 1);
  EXPECT_NE(call("CLOSE_LINE", {4}).find(":8003"), std::string::npos);
  t_c[4] = 39;
  cycle(2);
  EXPECT_EQ(line[4], 0) << "until somebody says so";
  EXPECT_EQ(call("CLOSE_LINE", {4}), "1 3 7");
  cycle(1);
  EXPECT_EQ(line[4], 1);
}

TEST_F(ThermalTest, ASwitchThatDoesNotOpenIsToldAndTheOthersGiveWayToIt) {
  t_c.fill(5);
  operate(by_set_points);
  stuck_w = heater_w;
  cycle(6);
  EXPECT_EQ(rig.heard(heaters_differ), 1);
  forget();
  cycle(100);
  EXPECT_LE(most_drawn_w, 60) << "with what nobody commanded";
  EXPECT_EQ(rig.heard(heaters_differ), 0);
}

TEST_F(ThermalTest, ChangesItsConfigurationWithoutABreak) {
  operate(by_set_points);
  const auto request = rig.configure(survival);
  cycle(3);
  EXPECT_EQ(rig.outcome(request), "1 3 7");
  EXPECT_EQ(rig.state(), State::Operational);
}

/// As many zones as the descriptor says, the same code.
TEST(Thermal, TakesAsManyZonesAsItsDescriptorHasAndNoneThatDiffer) {
  std::string text = descriptor::file_system()(HIROSCO_SOURCE_DIR "/subsystems/thermal/thermal.xml").value();
  const auto replace = [&](std::string_view what, std::string_view by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
      text.replace(at, what.size(), by);
  };
  replace("count=\"12\"", "count=\"2\"");
  for (const char* twelve : {"20 20 20 20 20 20 20 20 20 20 20 20", "10 10 10 10 10 10 10 10 10 10 10 10",
                             "-10 -10 -10 -10 -10 -10 -10 -10 -10 -10 -10 -10", "45 45 45 45 45 45 45 45 45 45 45 45",
                             "0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3 0.3", "0 1 2 3 4 5 6 7 8 9 10 11"}) {
    const std::string all{twelve};
    replace(all, all.substr(0, all.find(' ', all.find(' ') + 1)));
  }
  {
    const auto thermal = make_thermal();
    testing::Rig rig{*thermal, text};
    rig.bring_to(State::PreOperational, by_set_points);
    EXPECT_EQ(rig.state(), State::PreOperational);
    EXPECT_NE(rig.outcome(rig.call("SET_POINT", {2, 20})), "1 3 7");
  }
  const std::string fields = "<Field name=\"ON\" type=\"UINT8\" count=\"2\"";
  text.replace(text.find(fields), fields.size(), "<Field name=\"ON\" type=\"UINT8\" count=\"3\"");
  const auto thermal = make_thermal();
  testing::Rig rig{*thermal, text};
  EXPECT_NE(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_TRUE(std::ranges::any_of(rig.explanations, [](const std::string& line) {
    return line.find("as many elements") != std::string::npos;
  })) << "why it does not begin";
}

}  // namespace
}  // namespace hirosco
