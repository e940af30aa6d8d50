// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "missions/servicer/scenarios/servicer_craft.hpp"
#include "missions/servicer/scenarios/servicer_power.hpp"

/// The mission servicer on virtual time, judged by what its world tells. Its figures are the report's (`hirosco report servicer`); here
/// is what must not break between two of them.
namespace hirosco::simulation {
namespace {

const std::filesystem::path mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/servicer/mission.xml";

constexpr double away_m = 0.02, within_s = 2;

[[nodiscard]] double distance(const ServicerCraft::Place& one, const ServicerCraft::Place& other) {
  return std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
}

TEST(ServicerPage, ShowsTheRobotThatFlies) {
  const auto text = [](const char* file) {
    return descriptor::file_system()(std::filesystem::path{HIROSCO_SOURCE_DIR} / file).value();
  };
  EXPECT_EQ(text("missions/servicer/page/servicer.urdf"), text("subsystems/robot_arm/floating/floating_arm.urdf"));
}

/// Wheels and joints are never commanded together, whatever the ground asks for.
TEST(ServicerModes, NeverHaveWheelsAndJointsTogetherAndLetNobodyBringUpEitherByHand) {
  const auto reading = descriptor::read_mission(mission, descriptor::file_system());
  ASSERT_TRUE(reading.value);
  for (const auto& mode : reading.value->modes) {
    const auto has = [&](std::string_view subsystem, std::string_view configuration) {
      return std::ranges::any_of(mode.commission, [&](const auto& each) {
        return each.subsystem == subsystem && (configuration.empty() || each.configuration == configuration);
      });
    };
    EXPECT_FALSE(has("AOCS", "STATION_KEEPING") && has("MCS", "")) << mode.name;
    for (const auto& permit : mode.permits)
      for (const char* function : {"SET_STATE", "CONFIGURE", "ENTER_MODE"})
        EXPECT_EQ(std::ranges::count(permit.functions, std::string{function}), 0) << mode.name << ' ' << function;
  }
}

TEST(Servicer, TheSupervisorRefusesWhoeverWouldActBesideTheOther) {
  ServicerCraft craft{{.mission = mission, .mode = "track"}};
  for (const char* function : {"CONFIGURE", "SET_STATE"}) {
    const auto outcome = craft.craft().command("AOCS", function, {1.0});
    EXPECT_FALSE(outcome.completed) << function;
  }
  EXPECT_EQ(craft.flight().state("AOCS"), State::Operational);
  EXPECT_EQ(craft.craft().vital("AOCS")->configuration.load(), 2u) << "FREE_FLOAT";
  // The whole craft may be brought there: then the arm is gone before the wheels act.
  bool both = false;
  craft.craft().on_cycle([&](std::string_view, TimePoint) {
    const bool wheels =
        craft.flight().state("AOCS") == State::Operational && craft.craft().vital("AOCS")->configuration.load() == 1;
    both = both || (wheels && craft.flight().state("MCS") == State::Operational);
  });
  EXPECT_TRUE(craft.flight().set_mode("coast").completed) << craft.flight().story().text();
  EXPECT_FALSE(both);
  EXPECT_EQ(craft.flight().state("MCS"), State::Offline);
}

TEST(Servicer, MovesItsToolInInertialAxesWhileItsBaseGivesWay) {
  ServicerCraft craft{{.mission = mission, .mode = "track"}};
  const auto from = craft.tool_m();
  auto goal = from;
  goal[0] += away_m;
  const auto outcome = craft.craft().command("MCS", "MOVE_TOOL", {away_m, 0.0, 0.0, within_s}, 20s);
  EXPECT_TRUE(outcome.completed) << craft.flight().story().text();
  std::cout << "  off its goal: " << 1e3 * distance(craft.tool_m(), goal) << " mm, base turned by " << craft.base_deg()
            << " deg\n";
  EXPECT_LT(distance(craft.tool_m(), goal), 1.5e-3);
  EXPECT_GT(craft.base_deg(), 0.1);
  EXPECT_LT(craft.momentum_n_m_s(), 1e-6);
}

TEST(Servicer, MovesItsToolAndLeavesItsBaseUnturned) {
  ServicerCraft craft{{.mission = mission, .mode = "approach"}};
  const auto from = craft.tool_m();
  EXPECT_TRUE(craft.craft().command("MCS", "MOVE_TOOL", {0.0, 0.0, -away_m, within_s}, 20s).completed);
  EXPECT_NEAR(distance(craft.tool_m(), from), away_m, 2e-3);
  EXPECT_LT(craft.base_deg(), 0.01);
}

/// In a plane, where no joint is left over: the shoulder 0.1 rad before its end, which the way of the tool would pass.
TEST(Servicer, StopsItsToolBeforeAJointsEndAndIsLedBack) {
  ServicerCraft craft{{.mission = mission, .mode = "joints", .posture = "2.8,1.5708,1.5708,-1.2,0,1.2,0"}};
  constexpr std::size_t shoulder = 0;
  double farthest = 0;
  craft.each_cycle([&] { farthest = std::max(farthest, craft.robot().position(shoulder)); });
  const auto stopped = craft.craft().command("MCS", "MOVE_TOOL", {0.0, -0.3, 0.0, 25.0}, 40s);
  EXPECT_TRUE(stopped.started);
  EXPECT_EQ(stopped.failure, pus::FailureCode{0x8002}) << "OUT_OF_RANGE";
  EXPECT_TRUE(craft.flight().story().has("RANGE_END_NEAR")) << craft.flight().story().text();
  EXPECT_LT(farthest, 2.9);
  EXPECT_EQ(craft.flight().inhibited("MCS"), 0u) << "it stands by its law";
  EXPECT_TRUE(craft.craft().command("MCS", "MOVE_TOOL", {0.0, 0.02, 0.0, within_s}, 20s).completed)
      << craft.flight().story().text();
  craft.each_cycle([] {});
}

constexpr pus::FailureCode too_near{0x8009};

TEST(Servicer, RefusesAGoalInWhichItsArmWouldBeInItsBase) {
  ServicerCraft craft{{.mission = mission, .mode = "joints"}};
  const auto refused = craft.craft().command("MCS", "MOVE_JOINT", {0.1, -1.0, 0.0, -2.0, 0.0, 0.0, 0.0, 60.0}, 2s);
  EXPECT_FALSE(refused.started);
  EXPECT_EQ(refused.failure, too_near);
  craft.run(1);
  EXPECT_LT(craft.fastest_joint_rad_s(), 1e-3);
}

/// Where the last tube would be folded onto the one before, 0.15 rad farther on: the limit of 20 mm is reached at 2.51. The way is walked along while the arm stands.
TEST(Servicer, RefusesAStraightWayOnWhichItsLinksWouldMeet) {
  ServicerCraft craft{{.mission = mission, .mode = "joints", .posture = "0.107,0.76,-0.327,-1.758,-0.059,2.35,-0.005"}};
  constexpr std::size_t wrist_bend = 5;
  const double from = craft.robot().position(wrist_bend);
  const double begun_s = craft.time_s();
  const auto refused = craft.craft().command("MCS", "MOVE_TOOL", {-0.35, 0.0, -0.35, 25.0}, 40s);
  EXPECT_EQ(refused.failure, too_near) << craft.flight().story().text();
  EXPECT_LT(craft.time_s() - begun_s, 0.5) << "before it would be anywhere";
  craft.run(1);
  EXPECT_NEAR(craft.robot().position(wrist_bend), from, 1e-4);
  EXPECT_LT(craft.fastest_joint_rad_s(), 1e-3);
  EXPECT_TRUE(craft.craft().command("MCS", "MOVE_TOOL", {0.02, 0.0, 0.02, within_s}, 60s).completed)
      << craft.flight().story().text();
}

/// Both ends of the path are clear, and the base is between them. It is looked along while the arm stands.
TEST(Servicer, RefusesAWayOfJointsOnWhichItsLinksWouldMeetTheBase) {
  const std::vector<Value> to{1.57, -0.9, 0.0, -2.2, 0.0, 0.0, 0.0, 40.0};
  ServicerCraft craft{{.mission = mission, .mode = "joints", .posture = "-1.57,-0.9,0,-2.2,0,0,0"}};
  const double begun_s = craft.time_s();
  const auto refused = craft.craft().command("MCS", "MOVE_JOINT", to, 60s);
  EXPECT_TRUE(refused.started);
  EXPECT_EQ(refused.failure, too_near) << craft.flight().story().text();
  EXPECT_LT(craft.time_s() - begun_s, 0.5) << "before it would be anywhere";
  craft.run(1);
  EXPECT_NEAR(craft.robot().position(0), -1.57, 1e-4);
  EXPECT_LT(craft.fastest_joint_rad_s(), 1e-3);
  const std::vector<Value> away{-1.4, -0.9, 0.0, -2.2, 0.0, 0.0, 0.0, 5.0};
  EXPECT_TRUE(craft.craft().command("MCS", "MOVE_JOINT", away, 60s).completed) << craft.flight().story().text();
}

/// By its joints, in the laws that keep a tool: the base turns as it will, and what is then is kept.
TEST(Servicer, GoesBackByTheWayItsJointsCameAndHoldsWhereItIsThen) {
  for (const char* mode : {"track", "approach"}) {
    ServicerCraft craft{{.mission = mission, .mode = mode}};
    std::array<double, 7> from{};
    const auto off = [&] {
      double most = 0;
      for (std::size_t i = 0; i < from.size(); ++i)
        most = std::max(most, std::abs(craft.robot().position(i) - from.at(i)));
      return most;
    };
    for (std::size_t i = 0; i < from.size(); ++i) from.at(i) = craft.robot().position(i);
    ASSERT_TRUE(craft.craft().command("MCS", "MOVE_TOOL", {0.15, 0.0, 0.0, 8.0}, 40s).completed)
        << mode << craft.flight().story().text();
    ASSERT_GT(off(), 0.03) << mode;
    EXPECT_TRUE(craft.craft().command("MCS", "RETREAT", {1.0}, 40s).completed) << mode << craft.flight().story().text();
    EXPECT_TRUE(craft.flight().story().has("RETRACTED DISTANCE=")) << mode;
    EXPECT_LT(off(), 0.02) << mode;
    const auto tool = craft.tool_m();
    const double turned = craft.base_deg();
    craft.run(5);
    EXPECT_LT(distance(craft.tool_m(), tool), 5e-3) << mode;
    EXPECT_NEAR(craft.base_deg(), turned, 0.1) << mode << ": what was kept before is kept no more";
    EXPECT_LT(craft.momentum_n_m_s(), 1e-6) << mode;
    EXPECT_EQ(craft.flight().inhibited("MCS"), 0u) << mode;
  }
}

/// In inertial axes, while the base gives way: as far as its velocity by its time.
TEST(Servicer, JogsItsToolInInertialAxes) {
  for (const char* mode : {"track", "approach"}) {
    ServicerCraft craft{{.mission = mission, .mode = mode}};
    auto goal = craft.tool_m();
    goal[1] += 1.9 * 0.02;
    const double begun_s = craft.begin("JOG_L", {0.0, 0.02, 0.0, 0.0, 0.0, 0.0, 1.0});
    craft.run(begun_s + 0.9 - craft.time_s());
    EXPECT_TRUE(craft.craft().command("MCS", "JOG_L", {0.0, 0.02, 0.0, 0.0, 0.0, 0.0, 1.0}, 5s).completed)
        << mode << craft.flight().story().text();
    craft.run(3);
    EXPECT_LT(distance(craft.tool_m(), goal), 4e-3) << mode << ": of 38 mm, less what commands take on their way";
    EXPECT_LT(craft.momentum_n_m_s(), 1e-6) << mode;
    if (std::string_view{mode} == "approach") {
      EXPECT_LT(craft.base_deg(), 0.01);
    }
    const auto turned = craft.craft().command("MCS", "JOG_L", {0.0, 0.0, 0.0, 0.0, 0.0, 0.02, 0.5}, 5s);
    EXPECT_EQ(turned.completed, std::string_view{mode} == "track") << mode << ": who holds his attitude turns no tool";
    // By its joints it would be led away from what it keeps, and no mode of these permits it.
    EXPECT_FALSE(craft.craft().command("MCS", "JOG_J", {0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5}, 2s).completed) << mode;
    EXPECT_EQ(craft.flight().inhibited("MCS"), 0u) << mode;
  }
}

/// 20 kg at the tip, of which momentum takes its share: without being told of them the base would be turned by a tenth of a degree and more.
TEST(Servicer, LeavesItsBaseUnturnedWithAPayloadThatItWasToldOf) {
  constexpr double mass_kg = 20;
  std::array<double, 2> turned_deg{};
  for (const bool told : {false, true}) {
    ServicerCraft craft{{.mission = mission, .mode = "approach", .noise = Noise::None}};
    ASSERT_TRUE(craft.flight().device<MujocoDevice>("arm").fault("payload 20"));
    if (told) {
      ASSERT_TRUE(craft.craft().command("MCS", "SET_PAYLOAD", {mass_kg, 0.0, 0.0, 0.0}, 2s).completed)
          << craft.flight().story().text();
    }
    craft.each_cycle([&] { turned_deg[told] = std::max(turned_deg[told], craft.base_deg()); });
    // Not 0.1 m: at the end of those this posture, with its payload, is worse conditioned than the law may have it.
    EXPECT_TRUE(craft.craft().command("MCS", "MOVE_TOOL", {0.08, 0.0, 0.0, 10.0}, 40s).completed)
        << craft.flight().story().text();
    craft.each_cycle([] {});
  }
  std::cout << "  base turned by " << turned_deg[false] << " deg, " << turned_deg[true] << " deg by who was told\n";
  EXPECT_GT(turned_deg[false], 0.05);
  EXPECT_LT(turned_deg[true], 0.01);
}

/// 20 kg far before the tip are more than joints can turn the base back for, by the reckoning of the law itself.
TEST(Servicer, TakesNoPayloadWithWhichItCouldNotHoldItsAttitude) {
  ServicerCraft craft{{.mission = mission, .mode = "approach"}};
  const auto refused = craft.craft().command("MCS", "SET_PAYLOAD", {20.0, 0.0, 0.0, 0.3}, 2s);
  EXPECT_EQ(refused.failure, pus::FailureCode{0x8008}) << "ILL_CONDITIONED";
  craft.run(1);
  EXPECT_EQ(craft.flight().inhibited("MCS"), 0u) << "and none is in force";
  EXPECT_TRUE(craft.craft().command("MCS", "SET_TOOL", {0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0}, 2s).completed)
      << craft.flight().story().text();
  EXPECT_TRUE(craft.craft().command("MCS", "MOVE_TOOL", {away_m, 0.0, 0.0, within_s}, 20s).completed);
}

/// 32 N at the tool are 30 N m of the shoulder's 80, as a craft that nothing holds feels them. Whoever pushes is gone once he is felt: on a craft that
/// nothing holds every newton second stays, and turns it on.
TEST(Servicer, StandsWhereItMeetsSomebodyWhileItTracks) {
  ServicerCraft craft{{.mission = mission, .mode = "track"}};
  craft.begin("MOVE_TOOL", {0.1, 0.0, 0.0, 10.0});
  craft.run(3);
  EXPECT_FALSE(craft.flight().story().has("CONTACT")) << craft.flight().story().text();
  auto& arm = craft.flight().device<MujocoDevice>("arm");
  ASSERT_TRUE(arm.fault("push -32 0 0"));
  for (int i = 0; i < 50 && !craft.flight().story().has("CONTACT"); ++i) craft.run(0.001);
  ASSERT_TRUE(arm.fault("push 0 0 0"));
  EXPECT_TRUE(craft.flight().story().has("CONTACT")) << craft.flight().story().text();
  craft.run(3);
  const auto tool = craft.tool_m();
  craft.run(3);
  EXPECT_LT(distance(craft.tool_m(), tool), 5e-3);
  // It goes where it is told next. There it lags by what the craft drifts in a second, until somebody takes the momentum off.
  const auto stood = craft.tool_m();
  craft.begin("MOVE_TOOL", {-away_m, 0.0, 0.0, within_s});
  craft.run(within_s + 1);
  EXPECT_NEAR(craft.tool_m()[0] - stood[0], -away_m, 5e-3);
  EXPECT_EQ(craft.flight().inhibited("MCS"), 0u);
}

/// By the law that keeps the tool in inertial axes, with the noise of the star tracker. Who is told of a volume on his way is stopped before it, comes no nearer
/// however often he is to go there, and holds his tool there; who is told of it before is not let go.
TEST(Servicer, KeepsOutOfAVolumeWhileItTracks) {
  ServicerCraft craft{{.mission = mission, .mode = "track"}};
  const auto tool = craft.tool_m();
  // Across the way of the tool; the base is where it was, so its axes are the inertial ones.
  std::vector<Value> volumes(28, Value{0.0});
  const std::array numbers{tool[0] + 0.2, tool[1] - 1, tool[2], tool[0] + 0.2, tool[1] + 1, tool[2], 0.02};
  std::ranges::copy(numbers, volumes.begin());
  craft.begin("MOVE_TOOL", {0.2, 0.0, 0.0, 20.0});
  craft.run(2);
  ASSERT_TRUE(craft.craft().command("MCS", "KEEP_OUT", volumes, 2s).completed) << craft.flight().story().text();
  craft.run(20);
  EXPECT_TRUE(craft.flight().story().has("and a volume to keep out of")) << craft.flight().story().text();
  const auto first = craft.tool_m();
  EXPECT_GT(distance(tool, first), 0.02);
  for (int attempt = 1; attempt <= 3; ++attempt) {
    EXPECT_EQ(craft.craft().command("MCS", "MOVE_TOOL", {0.2, 0.0, 0.0, 20.0}, 1s).failure, too_near) << attempt;
    craft.run(2);
    EXPECT_LT(distance(craft.tool_m(), first), 0.004) << attempt;
  }
  EXPECT_EQ(craft.flight().inhibited("MCS"), 0u) << "what shakes at the limit stands by its law";
  EXPECT_TRUE(craft.craft().command("MCS", "MOVE_TOOL", {-away_m, 0.0, 0.0, within_s}, 20s).completed)
      << craft.flight().story().text();
}

/// The design's own stretched pose: the smallest singular value is 0.014.
TEST(Servicer, DoesNotHoldItsAttitudeFromAStretchedPosture) {
  ServicerCraft craft{{.mission = mission, .mode = "approach", .posture = "0.3,0.35,0.2,1.1,-0.3,0.5,0.1"}};
  craft.run(0.1);
  EXPECT_NE(craft.flight().inhibited("MCS"), 0u);
  EXPECT_TRUE(craft.flight().story().has("CONDITIONING_LOW"));
  EXPECT_FALSE(craft.craft().command("MCS", "MOVE_TOOL", {away_m, 0.0, 0.0, within_s}).completed);
}

TEST(Servicer, HandsItsStationOverWhenTheArmsControlDiesInMotion) {
  ServicerCraft craft{{.mission = mission, .mode = "track"}};
  craft.begin("MOVE_TOOL", {away_m, 0.0, 0.0, within_s});
  craft.run(1);
  craft.craft().kill("MCS");
  EXPECT_TRUE(craft.craft().run_until(
      [&] {
        return craft.flight().state("AOCS") == State::Operational &&
               craft.craft().vital("AOCS")->configuration.load() == 1;
      },
      1s))
      << craft.flight().story().text();
  EXPECT_LT(craft.fastest_joint_rad_s(), 1e-3) << "brakes";
  const double turned = craft.base_deg();
  craft.run(10);
  EXPECT_LT(craft.base_deg(), turned);
  EXPECT_EQ(craft.flight().inhibited("AOCS"), 0u);
  EXPECT_LT(craft.momentum_n_m_s(), 1e-6) << "the wheels have what the base gave";
}

TEST(Servicer, IsRefusedItsArmWhereTheSunDoesNotSuffice) {
  ServicerCraft craft{{.mission = mission, .mode = "coast"}};
  EXPECT_TRUE(ask_for_track(craft, {.sun_angle_deg = 69}).granted) << craft.flight().story().text();
  EXPECT_TRUE(craft.flight().set_mode("coast").completed);
  const Grant refused = ask_for_track(craft, {.sun_angle_deg = 70});
  EXPECT_FALSE(refused.granted);
  EXPECT_NEAR(refused.free_w, 900 * std::cos(70 * std::numbers::pi / 180) + 150 - 200, 1e-3);
  EXPECT_TRUE(craft.flight().story().has(": POWER.BUDGET_W measures it")) << craft.flight().story().text();
  EXPECT_EQ(craft.flight().state("AOCS"), State::Operational) << "it stays where it is";
  EXPECT_FALSE(ask_for_track(craft, {.eclipse = true}).granted);
}

TEST(Servicer, BrakesItsArmInAnEclipseAndTakesNobodysSupplyAway) {
  ServicerCraft craft{{.mission = mission, .mode = "track"}};
  const Brake seen = eclipse_in_motion(craft, 4);
  std::cout << "  told " << 1e3 * seen.told_s << " ms, at rest " << seen.rest_s << " s after the sun went\n";
  EXPECT_LT(seen.told_s, 0.05);
  EXPECT_LT(seen.rest_s, 0.5);
  EXPECT_EQ(craft.flight().state("MCS"), State::SafeOperational);
  EXPECT_EQ(craft.flight().state("AOCS"), State::Operational);
  EXPECT_TRUE(craft.flight().story().missing_in_order({"BUS_LOW", "plan bus-low"}).empty())
      << craft.flight().story().text();
  EXPECT_FALSE(craft.flight().story().has("LOAD_SHED"));
  auto& unit = craft.flight().device<SimulatedDevice>("power");
  const auto feeds_arm = [&] { return unit.truth().find("payload_on=1") != std::string::npos; };
  EXPECT_TRUE(feeds_arm());
  // What keeps the station is granted in the dark, the arm is not.
  EXPECT_FALSE(craft.flight().set_mode("track").completed);
  // Nearly empty: the plan takes the arm away, and then its outlet.
  ASSERT_TRUE(unit.fault("charge 0.15"));
  craft.run(2);
  EXPECT_EQ(craft.flight().state("MCS"), State::Offline) << craft.flight().story().text();
  EXPECT_FALSE(feeds_arm());
  EXPECT_EQ(craft.flight().state("POWER"), State::Operational);
  EXPECT_TRUE(craft.flight().set_mode("coast").completed) << craft.flight().story().text();
}

/// Who measures dies in motion: the arm goes on, nothing more is granted, and who measures comes back.
TEST(Servicer, NamesItsArmWhereItsOutletGivesMoreThanItClaimsForTenSeconds) {
  ServicerCraft craft{{.mission = mission, .mode = "track"}};
  craft.run(12);
  EXPECT_FALSE(craft.flight().story().has("POWER_EXCEEDED")) << craft.flight().story().text();
  auto& unit = craft.flight().device<SimulatedDevice>("power");
  ASSERT_TRUE(unit.fault("payload_load 300"));
  craft.run(9);
  EXPECT_FALSE(craft.flight().story().has("POWER_EXCEEDED"));
  craft.run(3);
  EXPECT_TRUE(craft.flight().story().has("power: 300 W are drawn by MCS, 280 W may be: POWER.LOADS.PAYLOAD"))
      << craft.flight().story().text();
  EXPECT_EQ(craft.flight().story().count("SUPERVISOR low POWER_EXCEEDED"), 1U);
  EXPECT_EQ(craft.flight().state("MCS"), State::Operational) << "no plan of this mission is for it";
  ASSERT_TRUE(unit.fault("payload_load 260"));
  craft.run(2);
  EXPECT_TRUE(craft.flight().story().has("MCS again no more than claimed"));
}

TEST(Servicer, GoesOnWithoutAMeasurementAndGrantsNothingMore) {
  ServicerCraft craft{{.mission = mission, .mode = "track"}};
  craft.begin("MOVE_TOOL", {away_m, 0.0, 0.0, within_s});
  craft.craft().kill("POWER");
  craft.run(0.1);
  EXPECT_TRUE(craft.flight().story().has("no more than 235 W are granted")) << craft.flight().story().text();
  EXPECT_EQ(craft.flight().state("MCS"), State::Operational);
  craft.run(3);
  EXPECT_EQ(craft.flight().state("MCS"), State::Operational);
  EXPECT_EQ(craft.flight().state("POWER"), State::Operational) << craft.flight().story().text();
  EXPECT_NE(craft.flight().device<SimulatedDevice>("power").truth().find("payload_on=1"), std::string::npos);
}

TEST(Servicer, FliesTheSameOctetsFromTheSameSeed) {
  const auto flown = [](std::uint64_t seed) {
    ServicerCraft craft{{.mission = mission, .seed = seed, .mode = "track"}};
    craft.begin("MOVE_TOOL", {away_m, 0.0, 0.0, within_s});
    craft.run(1);
    const auto& robot = craft.robot();
    std::vector<double> all(robot.data().qpos, robot.data().qpos + robot.model().nq);
    all.insert(all.end(), robot.data().qvel, robot.data().qvel + robot.model().nv);
    return all;
  };
  const auto first = flown(1);
  EXPECT_EQ(flown(1), first);
  EXPECT_NE(flown(2), first) << "noise of the star tracker";
}

}  // namespace
}  // namespace hirosco::simulation
