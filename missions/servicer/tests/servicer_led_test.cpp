// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/author/subsystem.hpp"
#include "missions/servicer/scenarios/servicer_craft.hpp"

/// The servicer's tool led over a real-time link in inertial axes (docs/adr/0245), in the world, with the noise of the base's pose: another subsystem says at 100 Hz where to.
namespace hirosco::simulation {
namespace {

namespace fs = std::filesystem;
const fs::path folder = fs::path{HIROSCO_SOURCE_DIR} / "missions/servicer";

constexpr const char* leader_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Subsystem name="LEADER" id="30">
  <Description>Leads the tool of an arm</Description>
  <Resources memory_kB="65536" shared_memory_kB="131072" threads="6" descriptors="64" processor_percent="90"/>
  <Parameters>
    <ParamRef name="POSITION" id="1" type="DOUBLE" count="3" unit="m"/>
    <ParamRef name="ORIENTATION" id="2" type="DOUBLE" count="4"/>
    <ParamRef name="VELOCITY" id="3" type="DOUBLE" count="3" unit="m/s"/>
    <ParamRef name="RATE" id="4" type="DOUBLE" count="3" unit="rad/s"/>
    <ParamRef name="ACTIVE" id="5" type="UINT8"/>
  </Parameters>
  <Configuration name="NOMINAL" id="1" priority="60" sampling_us="10000" budget_us="200">
    <FunctionService/>
    <EventService/>
    <TestService/>
    <RealTimeLinkService>
      <Provides name="GOAL" methods="shared_memory" byte_order="native" kind="latest">
        <ParamRef name="POSITION"/><ParamRef name="ORIENTATION"/><ParamRef name="VELOCITY"/><ParamRef name="RATE"/><ParamRef name="ACTIVE"/>
      </Provides>
    </RealTimeLinkService>
  </Configuration>
</Subsystem>
)";

/// What it says; a test's.
struct Led {
  std::array<double, 3> position_m{}, velocity_m_s{}, turning_rad_s{};
  std::array<double, 4> orientation_wxyz{1, 0, 0, 0};
};

class Leader final : public Subsystem {
 public:
  explicit Leader(std::shared_ptr<const Led> led) : led_{std::move(led)} {}

 private:
  Result<Step> software_init() override {
    publish("POSITION", position_);
    publish("ORIENTATION", orientation_);
    publish("VELOCITY", velocity_);
    publish("RATE", rate_);
    publish("ACTIVE", active_);
    return done;
  }
  Result<> operational(const Cycle&) noexcept override {
    position_.store(led_->position_m);
    orientation_.store(led_->orientation_wxyz);
    velocity_.store(led_->velocity_m_s);
    rate_.store(led_->turning_rad_s);
    active_.store(1);
    return ok();
  }

  std::shared_ptr<const Led> led_;
  Parameter<std::array<double, 3>> position_, velocity_, rate_;
  Parameter<std::array<double, 4>> orientation_;
  Parameter<std::uint8_t> active_;
};

/// The mission's, with somebody who leads and a mode in which he does.
[[nodiscard]] std::string led_mission() {
  std::string text = descriptor::file_system()(folder / "mission.xml").value();
  const auto before = [&](std::string_view place, const std::string& more) { text.insert(text.find(place), more); };
  before("\n  <!-- One world:", "  <Subsystem executable=\"hirosco-leader\" descriptor=\"leader.xml\"/>\n");
  before("  </Links>", "    <Link id=\"2\" from=\"LEADER.GOAL\" to=\"MCS.TOOL_POSE\" on_loss=\"ignore\"/>\n");
  const auto begin = text.find("    <Mode name=\"track\">"), end = text.find("    <Mode name=\"safe\">");
  std::string mode = text.substr(begin, end - begin);
  const auto replace = [&](std::string_view from, std::string_view to) {
    mode.replace(mode.find(from), from.size(), to);
  };
  replace("track", "led");
  replace("INERTIAL_TRACK", "TOOL_FOLLOW");
  replace("      <Commission subsystem=\"MCS\"",
          "      <Commission subsystem=\"LEADER\" configuration=\"NOMINAL\" state=\"Operational\"/>\n"
          "      <Commission subsystem=\"MCS\"");
  replace("      <Establish link=\"1\"/>\n", "      <Establish link=\"1\"/>\n      <Establish link=\"2\"/>\n");
  replace("functions=\"MOVE_TOOL", "functions=\"FOLLOW MOVE_TOOL");
  text.insert(end, mode);
  return text;
}

struct ServicerLed : ::testing::Test {
  std::shared_ptr<Led> led = std::make_shared<Led>();
  ServicerCraft craft{{.mission = folder / "led.xml",
                       .mode = "led",
                       .files = {{"led.xml", led_mission()}, {"leader.xml", leader_text}},
                       .subsystems = {{"hirosco-leader", [this] { return std::make_unique<Leader>(led); }}}}};

  void SetUp() override {
    led->position_m = craft.tool_m();
    std::ranges::copy(craft.robot().tip_orientation(), led->orientation_wxyz.begin());
    craft.run(0.1);
    ASSERT_TRUE(craft.craft().command("MCS", "FOLLOW", {}, 2s).completed) << craft.flight().story().text();
  }
  [[nodiscard]] double off_m() const {
    const auto is = craft.tool_m();
    return std::hypot(is[0] - led->position_m[0], is[1] - led->position_m[1], is[2] - led->position_m[2]);
  }
  /// Of the rotation between where its tool is turned to and where it is led.
  [[nodiscard]] double off_rad() const {
    const auto is = craft.robot().tip_orientation();
    double product = 0;
    for (std::size_t i = 0; i < 4; ++i) product += is[i] * led->orientation_wxyz.at(i);
    return 2 * std::acos(std::min(1.0, std::abs(product)));
  }
  /// Along x, and turned about z, for so long; from rest to rest.
  void lead(double m_s, double rad_s, double seconds) {
    constexpr double step_s = 0.01;
    const int steps = static_cast<int>(std::lround(seconds / step_s));
    for (int i = 0; i < steps; ++i) {
      const double share = std::min({1.0, 0.01 * i, 0.01 * (steps - i)});
      led->velocity_m_s = {share * m_s, 0, 0};
      led->turning_rad_s = {0, 0, share * rad_s};
      led->position_m[0] += step_s * share * m_s;
      const auto [w, x, y, z] = led->orientation_wxyz;
      const double half = step_s * share * rad_s / 2, c = std::cos(half), s = std::sin(half);
      led->orientation_wxyz = {c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w};
      craft.run(step_s);
    }
    led->velocity_m_s = led->turning_rad_s = {0, 0, 0};
  }
};

TEST_F(ServicerLed, FollowsWithItsToolInInertialAxesThoughItsBaseTurns) {
  ASSERT_NO_FATAL_FAILURE(lead(0.02, 0.02, 3));
  const double on_the_way_m = off_m();
  ASSERT_NO_FATAL_FAILURE(lead(0.02, 0.02, 3));
  craft.run(3);
  std::cout << "  " << 1e3 * on_the_way_m << " mm behind between two ways, " << 1e3 * off_m() << " mm and "
            << 1e3 * off_rad() << " mrad off at the end, base turned by " << craft.base_deg() << " deg\n";
  EXPECT_LT(off_m(), 2e-3) << craft.flight().story().text();
  EXPECT_LT(off_rad(), 3e-3);
  EXPECT_GT(craft.base_deg(), 0.1);
  EXPECT_EQ(craft.flight().inhibited("MCS"), 0u);
  EXPECT_FALSE(craft.flight().story().has("CONTACT")) << craft.flight().story().text();
}

TEST_F(ServicerLed, StandsWhereWhoeverLedItIsGone) {
  ASSERT_NO_FATAL_FAILURE(lead(0.02, 0, 2));
  led->velocity_m_s = {0.02, 0, 0};
  craft.craft().kill("LEADER");
  craft.run(2);
  EXPECT_TRUE(craft.flight().story().has("MCS low LEAD_LOST")) << craft.flight().story().text();
  const auto there = craft.tool_m();
  craft.run(2);
  const auto is = craft.tool_m();
  EXPECT_LT(std::hypot(is[0] - there[0], is[1] - there[1], is[2] - there[2]), 2e-3);
  EXPECT_EQ(craft.flight().state("MCS"), State::Operational) << craft.flight().story().text();
}

}  // namespace
}  // namespace hirosco::simulation
