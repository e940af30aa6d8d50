// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hirosco/pus/packet/failure_code.hpp"
#include "robotics/dynamics/dynamics.hpp"
#include "robotics/urdf/robot.hpp"
#include "simulation/devices/module.hpp"
#include "simulation/mujoco/mujoco_device.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "subsystems/robot_arm/testing/sensing.hpp"

/// The mission six_joints on virtual time, judged by what its world tells, which shares nothing with the arm but a file.
namespace hirosco {
namespace {

using Joints = std::array<double, 6>;
using Place = std::array<double, 3>;

constexpr Joints start{0.2, 0.5, 1.2, -0.6, 0.7, 0.1};
constexpr Joints goal{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0};

struct SixJoints : ::testing::Test {
  std::optional<simulation::Flight> flown;
  std::function<void(descriptor::Mission&)> edit;  ///< of the mission, before it flies
  simulation::DeviceCatalogue devices;  ///< in place of modules
  std::map<std::string, std::string> files;  ///< in place of files

  /// `differs`: how the world differs from the mission's own.
  void fly(const std::vector<std::string>& differs = {}, std::uint64_t seed = 1) {
    flown.emplace(
        simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/six_joints/mission.xml",
                         .edit = edit,
                         .subsystems = {},
                         .devices = devices,
                         .files = files,
                         .seed = seed});
    for (const std::string& line : differs) {
      const auto taken = arm().fault(line);
      ASSERT_TRUE(taken) << line << ": " << taken.error().text;
    }
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  simulation::SimulatedDevice& arm() { return *flown->craft().device("arm"); }
  static double word(const std::string& words, const std::string& name) {
    const auto at = (" " + words).find(" " + name + "=");
    return at == words.npos ? NAN : std::atof(words.c_str() + at + name.size() + 1);
  }
  Joints joints() {
    const std::string words = arm().truth();
    Joints found;
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = word(words, fmt::format("q{}", i + 1));
    return found;
  }
  Place tip() {
    const std::string words = arm().truth();
    return {word(words, "tip_x"), word(words, "tip_y"), word(words, "tip_z")};
  }
  double off(const Joints& where) {
    const Joints now = joints();
    double most = 0;
    for (std::size_t i = 0; i < where.size(); ++i) most = std::max(most, std::abs(now[i] - where[i]));
    return most;
  }
  double fastest() {
    const std::string words = arm().truth();
    double most = 0;
    for (std::size_t i = 1; i <= 6; ++i) most = std::max(most, std::abs(word(words, fmt::format("qd{}", i))));
    return most;
  }
  simulation::CommandOutcome move_j(const Joints& where, double speed = 1) {
    std::vector<Value> numbers(where.begin(), where.end());
    numbers.emplace_back(speed);
    return flown->craft().command("ARM", "MOVE_J", numbers, 70s);
  }
};

TEST(SixJointsPage, ShowsTheRobotThatFlies) {
  const auto text = [](const char* file) {
    return descriptor::file_system()(std::filesystem::path{HIROSCO_SOURCE_DIR} / file).value();
  };
  EXPECT_EQ(text("missions/six_joints/page/robot_arm.urdf"), text("subsystems/robot_arm/robot_arm.urdf"));
}

TEST_F(SixJoints, ReachesItsGoalsWithinAMilliradianHoweverTheWorldDiffersFromTheFile) {
  struct Case {
    const char* name;
    std::vector<std::string> differs;
    double declared_kg{0};
  };
  const std::array cases{Case{"as the file says", {"mass 1", "friction 1"}},
                         Case{"masses, rotors, inertias, friction",
                              {"mass 1.1", "friction 3", "inertia 1.05", "rotors 0.55,0.55,0.44,0.11,0.11,0.11"}},
                         Case{"2 kg undeclared", {"mass 1", "friction 1", "payload 2"}},
                         Case{"2 kg declared", {"mass 1", "friction 1", "payload 2"}, 2}};
  for (const Case& each : cases) {
    fly(each.differs);
    if (each.declared_kg > 0) {
      ASSERT_TRUE(flown->craft().command("ARM", "SET_PAYLOAD", {each.declared_kg, 0.0, 0.0, 0.0}).completed);
    }
    double most = 0;
    for (const Joints& where : {goal, start}) {
      const auto outcome = move_j(where);
      EXPECT_TRUE(outcome.completed) << each.name << "\n" << flown->story().text();
      EXPECT_EQ(outcome.progress_reports, 1) << each.name;
      most = std::max(most, off(where));
    }
    std::cout << fmt::format("  {}: {:.2f} mrad\n", each.name, 1e3 * most);
    EXPECT_LE(most, 1e-3) << each.name;
    EXPECT_EQ(flown->inhibited("ARM"), 0u);
  }
}

/// World and arm agree on what a sensor at the tip tells of a load, however the tip is turned.
TEST_F(SixJoints, FeelsAtItsTipWhatPushesItAndStandsForItWithoutWhatItCarries) {
  const auto descriptor = std::filesystem::path{HIROSCO_SOURCE_DIR} / "subsystems/robot_arm/robot_arm.xml";
  files["robot_arm.xml"] = robot_arm::testing::with_force_sensor(descriptor::file_system()(descriptor).value());
  edit = [](descriptor::Mission& mission) { mission.devices.front().settings.push_back({"force_sensor", "on", {}}); };
  ASSERT_NO_FATAL_FAILURE(fly({"payload 2"}));
  ASSERT_TRUE(flown->craft().command("ARM", "SET_PAYLOAD", {2.0, 0.0, 0.0, 0.0}).completed) << flown->story().text();
  EXPECT_TRUE(move_j(goal, 0.3).completed) << "what it carries is no contact\n" << flown->story().text();
  EXPECT_FALSE(flown->story().has("WRIST_CONTACT"));
  ASSERT_TRUE(arm().fault("push 0 40 0"));
  flown->craft().run(200ms);
  EXPECT_TRUE(flown->story().has("ARM low WRIST_CONTACT")) << flown->story().text();
  ASSERT_TRUE(arm().fault("push 0 0 0"));
  ASSERT_TRUE(arm().fault("force_sensor silent"));
  flown->craft().run(200ms);
  EXPECT_TRUE(flown->story().has("ARM low FORCE_SENSOR_LOST")) << flown->story().text();
  EXPECT_EQ(flown->state("ARM"), State::Operational);
  EXPECT_TRUE(move_j(start, 0.3).completed) << "and goes on by what its joints feel\n" << flown->story().text();
}

/// The same arm as MuJoCo's own reader has it, among other things: a floor, and a crate that falls onto it. Its links touch
/// nothing.
std::string room() {
  const std::filesystem::path file{HIROSCO_SOURCE_DIR "/subsystems/robot_arm/robot_arm.urdf"};
  std::string text = descriptor::file_system()(file).value();
  text.insert(text.find("<link"), R"(<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco>)");
  std::array<char, 1000> why{};
  const std::unique_ptr<mjSpec, simulation::MujocoFree> spec{
      mj_parseXMLString(text.c_str(), nullptr, why.data(), why.size())};
  EXPECT_NE(spec, nullptr) << why.data();
  for (auto* each = mjs_firstElement(spec.get(), mjOBJ_GEOM); each != nullptr; each = mjs_nextElement(spec.get(), each))
    mjs_asGeom(each)->contype = mjs_asGeom(each)->conaffinity = 0;
  const simulation::MujocoModel compiled{mj_compile(spec.get(), nullptr)};
  EXPECT_NE(compiled, nullptr) << mjs_getError(spec.get());
  std::string scene(std::size_t{1} << 16, '\0');
  EXPECT_EQ(mj_saveXMLString(spec.get(), scene.data(), static_cast<int>(scene.size()), why.data(), why.size()), 0)
      << why.data();
  scene.resize(scene.find('\0'));
  scene.insert(scene.find("<worldbody>") + std::string_view{"<worldbody>"}.size(),
               R"(<geom name="floor" type="plane" size="5 5 0.1" pos="0 0 -0.5"/>
    <body name="crate" pos="1.5 1.5 1"><freejoint/><geom type="box" size="0.2 0.2 0.2" mass="5"/></body>)");
  const std::string named = ::testing::TempDir() + "room.xml";
  std::ofstream{named} << scene;
  return named;
}

TEST_F(SixJoints, ReachesItsGoalsInAWorldOfAnMjcfFileThatTheMissionNames) {
  devices["hirosco-sim-mujoco"] = simulation::make_device<simulation::MujocoDevice>;
  edit = [](descriptor::Mission& mission) { mission.devices.front().settings.push_back({"WORLD_FILE", room(), {}}); };
  fly();
  for (const Joints& where : {goal, start}) {
    const auto outcome = move_j(where);
    EXPECT_TRUE(outcome.completed) << flown->story().text();
    EXPECT_LE(off(where), 1e-3);
  }
  const auto& world = static_cast<const simulation::MujocoDevice&>(arm()).robot();
  const int crate = mj_name2id(&world.model(), mjOBJ_BODY, "crate");
  ASSERT_GE(crate, 0);
  EXPECT_NEAR(world.data().xpos[3 * crate + 2], -0.3, 1e-2) << "it has fallen meanwhile";
}

TEST_F(SixJoints, GoesStraightWithinTwoMillimetres) {
  fly();
  const auto reading =
      robotics::urdf::read(HIROSCO_SOURCE_DIR "/subsystems/robot_arm/robot_arm.urdf", descriptor::file_system());
  const auto model = robotics::Model::make(robotics::urdf::describe(reading.value.value())).value();
  robotics::Dynamics kinematics{model, robotics::Base::Fixed};
  const auto tool = [&] {
    const Joints now = joints();
    robotics::State state;
    state.q = Eigen::Map<const Eigen::VectorXd>(now.data(), 6);
    state.qd = robotics::JointVector::Zero(6);
    kinematics.update(state);
    return kinematics.frame_pose(model.find_frame("tool").value());
  };
  const robotics::Pose from = tool();
  const Place seen = tip();
  EXPECT_LT((from.position - robotics::Vector3{seen[0], seen[1], seen[2]}).norm(), 1e-5) << "both read the file alike";
  const robotics::Vector3 way{-0.2, 0.15, 0.1};
  const robotics::Vector3 to = from.position + way;
  const robotics::Quaternion kept{from.rotation};
  double beside_m = 0;
  flown->craft().on_cycle([&, cycles = 0](std::string_view, TimePoint) mutable {
    if (++cycles % 10 != 0) return;
    const Place now = tip();
    const robotics::Vector3 gone = robotics::Vector3{now[0], now[1], now[2]} - from.position;
    beside_m = std::max(beside_m, (gone - gone.dot(way) / way.squaredNorm() * way).norm());
  });
  const auto outcome = flown->craft().command(
      "ARM", "MOVE_L", {to.x(), to.y(), to.z(), kept.w(), kept.x(), kept.y(), kept.z(), 0.25, 0.5}, 20s);
  EXPECT_TRUE(outcome.completed) << flown->story().text();
  std::cout << fmt::format("  beside its line: {:.2f} mm, off its goal {:.2f} mm\n", 1e3 * beside_m,
                           1e3 * (tool().position - to).norm());
  EXPECT_LE(beside_m, 0.002);
  EXPECT_LE((tool().position - to).norm(), 0.001);
}

TEST_F(SixJoints, AnUnpluggedArmIsHeldByItsBrakesAndItsNetworkGoesDown) {
  fly();
  flown->craft().on_cycle([&, cycles = 0](std::string_view, TimePoint) mutable {
    if (++cycles == 700) {
      ASSERT_TRUE(arm().fault("unplug"));
    }
  });
  const auto outcome = move_j(goal);
  EXPECT_FALSE(outcome.completed);
  EXPECT_TRUE(flown->story().has("ARM high ARM_LOST")) << flown->story().text();
  ASSERT_TRUE(flown->run_until_state("ARM", State::Offline, 5s)) << flown->story().text();
  flown->craft().run(1s);
  EXPECT_LT(fastest(), 1e-3);
  EXPECT_GT(off(goal), 0.1) << "it did not arrive";
  EXPECT_FALSE(arm().active());
}

TEST_F(SixJoints, IsStoppedByALimitAndBroughtToSafeOperational) {
  fly();
  ASSERT_TRUE(flown->craft().command("ARM", "SET_CONTACT", {std::uint8_t{0}, 1.0}).completed);
  ASSERT_TRUE(flown->craft().command("ARM", "SET_TORQUE_LIMIT", {0.6}).completed) << flown->story().text();
  ASSERT_TRUE(arm().fault("push 0 0 -100"));
  ASSERT_TRUE(flown->run_until_state("ARM", State::SafeOperational, 5s)) << flown->story().text();
  EXPECT_TRUE(flown->story().has("_LIMIT_EXCEEDED")) << flown->story().text();
  ASSERT_TRUE(arm().fault("push 0 0 0"));
  flown->craft().run(1s);
  EXPECT_LT(fastest(), 1e-3);
}

TEST_F(SixJoints, StaysWhereItMeetsSomebody) {
  fly();
  flown->craft().on_cycle([&, cycles = 0](std::string_view, TimePoint) mutable {
    ++cycles;
    if (cycles == 500 || cycles == 900) {
      ASSERT_TRUE(arm().fault(cycles == 500 ? "push 0 120 0" : "push 0 0 0"));
    }
  });
  const auto outcome = move_j(goal);
  EXPECT_EQ(static_cast<std::uint16_t>(outcome.failure.value()), 0x8004) << flown->story().text();
  flown->craft().run(2s);
  EXPECT_LT(fastest(), 1e-3);
  EXPECT_EQ(flown->state("ARM"), State::Operational);
  EXPECT_TRUE(move_j(goal).completed) << flown->story().text();
}

constexpr const char* post_in_its_way = "obstacle_post cylinder 0.05,1.6 0.5,-0.15,0.8 0.5";

/// Only its world knows of the post, and tells how fast and how hard the arm meets it.
TEST_F(SixJoints, IsStoppedByItsObserverAtAnObstacleThatNobodyToldItOf) {
  ASSERT_NO_FATAL_FAILURE(fly({post_in_its_way}));
  double most_n = 0, met_rad_s = 0;
  std::optional<double> met_s, stood_s;
  flown->craft().on_cycle([&, cycles = 0](std::string_view, TimePoint) mutable {
    const double now_s = 1e-3 * ++cycles, force_n = word(arm().truth(), "contact_n");
    most_n = std::max(most_n, force_n);
    if (!met_s && force_n > 0) met_s = now_s;
    if (!met_s) met_rad_s = fastest();
    if (met_s && !stood_s && fastest() < 0.05) stood_s = now_s;
  });
  const auto outcome = move_j(goal, 0.2);
  EXPECT_EQ(static_cast<std::uint16_t>(outcome.failure.value()), 0x8004) << flown->story().text();
  EXPECT_TRUE(flown->story().has("ARM low CONTACT JOINT=turn")) << flown->story().text();
  flown->craft().run(1s);
  EXPECT_LT(fastest(), 1e-3);
  EXPECT_EQ(flown->state("ARM"), State::Operational);
  EXPECT_EQ(flown->inhibited("ARM"), 0u);
  ASSERT_TRUE(met_s && stood_s);
  EXPECT_LT(*stood_s - *met_s, 0.1);
  std::cout << fmt::format("  met at {:.2f} rad/s, stood {:.0f} ms later, peak {:.0f} N, {:.0f} N then\n", met_rad_s,
                           1e3 * (*stood_s - *met_s), most_n, word(arm().truth(), "contact_n"));
  EXPECT_TRUE(move_j(start).completed) << "it may go away\n" << flown->story().text();
  EXPECT_EQ(word(arm().truth(), "contacts"), 0);
}

/// What its drives' own masses do in the gears is more than its torque limit, before the observer has seen it.
TEST_F(SixJoints, IsStoppedByItsTorqueLimitAtAnObstacleThatItMeetsAtFullSpeed) {
  ASSERT_NO_FATAL_FAILURE(fly({post_in_its_way}));
  double most_n = 0;
  flown->craft().on_cycle(
      [&](std::string_view, TimePoint) { most_n = std::max(most_n, word(arm().truth(), "contact_n")); });
  const auto outcome = move_j(goal);
  EXPECT_EQ(static_cast<std::uint16_t>(outcome.failure.value()), 0x8003) << flown->story().text();
  flown->craft().run(1s);
  EXPECT_LT(fastest(), 1e-3);
  EXPECT_FALSE(arm().active());
  std::cout << fmt::format("  peak {:.0f} N\n", most_n);
}

/// One push on the way, and what becomes of it.
TEST_F(SixJoints, FloatsOrBacksOffWhereItMeetsSomebodyAsItWasTold) {
  for (const auto reaction : {std::uint8_t{2}, std::uint8_t{3}}) {
    fly();
    ASSERT_TRUE(flown->craft().command("ARM", "SET_CONTACT", {reaction, 0.3}).completed) << flown->story().text();
    Joints met{};
    flown->craft().on_cycle([&, cycles = 0](std::string_view, TimePoint) mutable {
      ++cycles;
      if (cycles == 500 || cycles == 900) {
        ASSERT_TRUE(arm().fault(cycles == 500 ? "push 0 120 0" : "push 0 0 0"));
      }
      if (cycles == 500) met = joints();
    });
    const auto outcome = move_j(goal);
    EXPECT_EQ(static_cast<std::uint16_t>(outcome.failure.value()), 0x8004) << flown->story().text();
    flown->craft().run(2s);
    EXPECT_LT(fastest(), 0.02);
    EXPECT_EQ(flown->inhibited("ARM"), 0u) << flown->story().text();
    std::cout << fmt::format("  reaction {}: {:.3f} rad from where it was met\n", reaction, off(met));
    if (reaction == 2) {
      EXPECT_TRUE(flown->story().has("REACTION=Float")) << flown->story().text();
      EXPECT_GT(off(met), 0.15) << "it was pushed aside";
      EXPECT_EQ(static_cast<std::uint16_t>(move_j(goal).failure.value()), 0x800c);
      EXPECT_TRUE(flown->craft().command("ARM", "HOLD", {}).completed);
    } else {
      EXPECT_TRUE(flown->story().has("RETRACTED DISTANCE=")) << flown->story().text();
    }
    flown->craft().run(1s);
    EXPECT_LT(fastest(), 1e-3);
    EXPECT_TRUE(move_j(goal).completed) << flown->story().text();
  }
}

/// A tenth heavier than its model says: it carries what it has learnt of that, and meets nobody for it.
TEST_F(SixJoints, FloatsWhenItIsToldToAndIsLedByHand) {
  fly();
  flown->craft().run(3s);
  ASSERT_TRUE(flown->craft().command("ARM", "FLOAT", {}).completed) << flown->story().text();
  flown->craft().run(2s);
  std::cout << fmt::format("  floats {:.4f} rad away in 2 s\n", off(start));
  EXPECT_LT(off(start), 0.05) << "nobody leads it";
  ASSERT_TRUE(arm().fault("push 0 20 0"));
  flown->craft().run(600ms);
  ASSERT_TRUE(arm().fault("push 0 0 0"));
  flown->craft().run(2s);
  EXPECT_GT(off(start), 0.1) << "it was led";
  EXPECT_FALSE(flown->story().has("ARM low CONTACT")) << flown->story().text();
  EXPECT_EQ(static_cast<std::uint16_t>(move_j(goal).failure.value()), 0x800c);
  const Joints left = joints();
  EXPECT_TRUE(flown->craft().command("ARM", "HOLD", {}).completed) << flown->story().text();
  flown->craft().run(1s);
  EXPECT_LT(fastest(), 1e-3);
  EXPECT_LT(off(left), 0.05) << "it holds where it was left";
  EXPECT_EQ(flown->inhibited("ARM"), 0u) << flown->story().text();
  EXPECT_TRUE(move_j(goal).completed) << flown->story().text();
}

TEST_F(SixJoints, IsSoftWhenItIsToldTo) {
  fly();
  ASSERT_TRUE(flown->craft().command("ARM", "IMPEDANCE_L", {500.0, 30.0, 0.7}).completed) << flown->story().text();
  const Place before = tip();
  ASSERT_TRUE(arm().fault("push 0 0 40"));
  flown->craft().run(1500ms);
  const double aside_m = tip()[2] - before[2];
  std::cout << fmt::format("  40 N push it {:.1f} mm\n", 1e3 * aside_m);
  // 80 mm, less what dry friction holds.
  EXPECT_LT(aside_m, 0.085);
  EXPECT_GT(aside_m, 0.03);
  EXPECT_EQ(flown->inhibited("ARM"), 0u) << flown->story().text();
  ASSERT_TRUE(arm().fault("push 0 0 0"));
  flown->craft().run(1s);
  EXPECT_TRUE(flown->craft().command("ARM", "POSITION_CONTROL", {}).completed) << flown->story().text();
}

TEST(SixJointsWorld, ThatCannotBeMadeIsToldWithItsReason) {
  simulation::Flight flight{{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/six_joints/mission.xml",
                             .edit =
                                 [](descriptor::Mission& mission) {
                                   for (auto& member : mission.subsystems)
                                     for (auto& configuration : member.subsystem.configurations)
                                       for (auto& use : configuration.devices)
                                         for (auto& setting : use.settings)
                                           if (setting.name == "MODEL_FILE") setting.value = "nowhere.urdf";
                                 },
                             .subsystems = {},
                             .devices = {}}};
  EXPECT_TRUE(flight.story().has("no simulated device arm: ")) << flight.story().text();
  EXPECT_TRUE(flight.story().has("nowhere.urdf")) << flight.story().text();
  EXPECT_FALSE(flight.commission());
}

/// reach_and_back.script of the mission, played on board.
TEST_F(SixJoints, PlaysAScriptThereAndBack) {
  ASSERT_NO_FATAL_FAILURE(fly());
  const Joints there{-0.4, 0.2, 0.9, 0.1, 0.2, 0.5};
  double nearest = 10;
  flown->story().on_telemetry = [&](const pus::TelemetryView&) { nearest = std::min(nearest, off(there)); };
  const auto outcome = flown->craft().command("PLAYER", "PLAY", {std::string{"REACH_AND_BACK"}}, 30s);
  flown->story().on_telemetry = {};
  EXPECT_TRUE(outcome.completed) << flown->story().text();
  EXPECT_LT(nearest, 2e-3);
  EXPECT_LT(off(start), 2e-3);
  // A hold of the ground ends the motion under way, and with it the script.
  static_cast<void>(flown->craft().command("PLAYER", "PLAY", {std::string{"REACH_AND_BACK"}}, 300ms));
  EXPECT_TRUE(flown->craft().command("ARM", "HOLD", {}, 5s).completed) << flown->story().text();
  EXPECT_TRUE(flown->story().has("PLAYER low SCRIPT_STOPPED LINE=7")) << flown->story().text();
}

TEST_F(SixJoints, GivesTheSameOctetsTwice) {
  std::array<std::vector<supervisor::LogRecord>, 2> records;
  for (auto& each : records) {
    ASSERT_NO_FATAL_FAILURE(fly({"noise 0.1", post_in_its_way}));
    EXPECT_FALSE(move_j(goal, 0.2).completed);
    flown->craft().run(1s);
    EXPECT_TRUE(move_j(start).completed);
    each = flown->records();
  }
  EXPECT_GT(records[0].size(), 100u);
  EXPECT_TRUE(records[0] == records[1]);
}

}  // namespace
}  // namespace hirosco
