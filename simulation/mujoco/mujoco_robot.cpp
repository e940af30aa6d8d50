// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_robot.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "simulation/mujoco/mujoco_scene.hpp"
#include "simulation/mujoco/mujoco_urdf.hpp"

namespace hirosco::simulation {

MujocoRobot::MujocoRobot(MujocoSpec spec)
    : world_{std::move(spec)}, drives_{world_.spec().joints()}, contacts_{world_.spec()} {}

std::expected<MujocoRobot, std::string> MujocoRobot::make(std::string_view urdf, const MeshSource& meshes) {
  auto spec = spec_of_urdf(urdf, meshes);
  if (!spec) return std::unexpected{std::move(spec.error())};
  return make(std::move(*spec));
}

std::expected<MujocoRobot, std::string> MujocoRobot::make_in_scene(std::string_view mjcf, std::string_view urdf,
                                                                   const MeshSource& files) {
  auto joints = driven_joints(urdf);
  if (!joints) return std::unexpected{std::move(joints.error())};
  auto spec = spec_of_scene(mjcf, std::move(*joints), files);
  if (!spec) return std::unexpected{std::move(spec.error())};
  return make(std::move(*spec));
}

std::expected<MujocoRobot, std::string> MujocoRobot::make(MujocoSpec spec) {
  MujocoRobot robot{std::move(spec)};
  if (auto built = robot.build({}, {}); !built) return std::unexpected{std::move(built.error())};
  return robot;
}

std::expected<void, std::string> MujocoRobot::build(std::span<const Obstacle> obstacles, LooseBodies bodies) {
  auto next = world_.compile(obstacles, bodies.all());
  if (!next) return std::unexpected{std::move(next.error())};
  if (auto found = drives_.find(*next->model); !found) return found;
  contacts_.soften(*next->model, world_.spec());
  world_.become(std::move(*next));
  bodies_ = std::move(bodies);
  for (std::size_t robot = 0; robot < links_.size(); ++robot)
    links_[robot].find(world_, drives_, robot, bodies_.first(world_.model()));
  contacts_.count_robots(links_.size());
  drives_.close_brakes(world_);
  RobotLinks::weigh(world_, links_);
  return {};
}

std::expected<void, std::string> MujocoRobot::surround(std::vector<Obstacle> obstacles, LooseBodies bodies,
                                                       std::string_view moved) {
  const LooseBodies bodies_before = bodies_;
  const Standing before{world_, bodies_};
  Standing after = before;
  after.leave_out(moved);
  if (auto built = build(obstacles, std::move(bodies)); !built) return built;
  stand(after);
  if (auto within = Contacts::overlap(world_)) {
    // What was there before could be made.
    if (auto built = build(obstacles_, bodies_before); !built) return built;
    stand(before);
    return std::unexpected{*within + ", where the robot is now"};
  }
  obstacles_ = std::move(obstacles);
  return {};
}

void MujocoRobot::stand(const Standing& standing) noexcept {
  standing.restore(world_, bodies_);
  bodies_.apply(world_);
  world_.forward();
  feel();
}

void MujocoRobot::feel() noexcept {
  drives_.feel(world_);
  contacts_.feel(world_, links_, bodies_);
}

std::expected<void, std::string> MujocoRobot::put(const Obstacle& obstacle) {
  std::vector<Obstacle> all = obstacles_;
  const auto found = std::ranges::find(all, obstacle.name, &Obstacle::name);
  if (found != all.end()) *found = obstacle;
  else if (all.size() == most_obstacles) return std::unexpected{fmt::format("there are {} obstacles", most_obstacles)};
  else all.push_back(obstacle);
  return surround(std::move(all), bodies_);
}

std::expected<void, std::string> MujocoRobot::take_away(std::string_view name) {
  std::vector<Obstacle> all = obstacles_;
  if (std::erase_if(all, [&](const Obstacle& each) { return each.name == name; }) == 0)
    return std::unexpected{fmt::format("there is no obstacle '{}'", name)};
  return surround(std::move(all), bodies_);
}

std::expected<void, std::string> MujocoRobot::lay(const LooseBody& body) {
  auto all = bodies_.with(body);
  if (!all) return std::unexpected{std::move(all.error())};
  return surround(obstacles_, std::move(*all), body.standing.name);
}

std::expected<void, std::string> MujocoRobot::take_body_away(std::string_view name) {
  auto all = bodies_.without(name);
  if (!all) return std::unexpected{std::move(all.error())};
  return surround(obstacles_, std::move(*all));
}

std::expected<void, std::string> MujocoRobot::let_float() {
  if (auto done = world_.spec().let_float(); !done) return done;
  return build(obstacles_, bodies_);
}

std::expected<std::size_t, std::string> MujocoRobot::mount(MujocoSpec robot, const Mount& at) {
  auto with = world_.spec().with(std::move(robot), at);
  if (!with) return std::unexpected{std::move(with.error())};
  if (auto done = become(std::move(*with)); !done) return std::unexpected{std::move(done.error())};
  return links_.size() - 1;
}

std::expected<void, std::string> MujocoRobot::become(MujocoSpec spec,
                                                     const std::function<std::optional<std::string>()>& judge) {
  const Standing before{world_, bodies_};
  const JointDrives drives_before = drives_;
  const std::vector<RobotLinks> links_before = links_;
  MujocoSpec spec_before = std::exchange(world_.spec(), std::move(spec));
  drives_.add(std::span{world_.spec().joints()}.subspan(drives_.count()));
  links_.resize(world_.spec().robots().size());
  const auto built = build(obstacles_, bodies_);
  const std::optional<std::string> against = !built ? std::optional{built.error()} : judge ? judge() : std::nullopt;
  if (against) {
    world_.spec() = std::move(spec_before);
    drives_ = drives_before;
    links_ = links_before;
    // What was there before could be made.
    static_cast<void>(build(obstacles_, bodies_));
  }
  stand(before);
  if (against) return std::unexpected{*against};
  return {};
}

std::expected<void, std::string> MujocoRobot::give_way(std::span<const double> stiffness,
                                                       std::span<const double> damping, std::size_t robot) {
  // Its springs come between what is numbered already.
  if (robot + 1 != robots()) return std::unexpected{"its joints are to give way before another robot is mounted"};
  const auto springs = drives_.springs(stiffness, damping, of(robot), world_);
  if (!springs) return std::unexpected{springs.error()};
  auto with = world_.spec().giving_way(*springs, robot);
  if (!with) return std::unexpected{std::move(with.error())};
  return become(std::move(*with), [&] { return drives_.too_fast(of(robot), world_); });
}

std::expected<void, std::string> MujocoRobot::set_tip(const std::string& link, std::size_t robot) {
  if (!world_.spec().hang_payload_on(link, robot)) return std::unexpected{fmt::format("there is no link '{}'", link)};
  const Standing before{world_, bodies_};
  if (auto built = build(obstacles_, bodies_); !built) return built;
  stand(before);
  return {};
}

void MujocoRobot::set_in_motion(const std::array<double, 6>& base_twist, std::span<const double> velocities) noexcept {
  if (base().floats()) base().set_twist(data(), base_twist);
  drives_.set_in_motion(velocities, world_);
  if (base().floats()) base().set_wheels(data(), {});
  world_.forward();
}

std::expected<void, std::string> MujocoRobot::place(std::span<const double> positions, std::size_t robot) {
  const Standing before{world_, bodies_};
  world_.reset();
  if (bodies_.count() > 0 || robots() > 1) {
    Standing kept{world_, bodies_};
    kept.take_bodies_of(before);
    const mjModel& model = world_.model();
    kept.take_joints_of(before, model, [&](int body) { return world_.spec().robot_of(model, body) != robot; });
    stand(kept);
  }
  drives_.place(positions.first(std::min(positions.size(), joints(robot))), of(robot).first_joint, world_);
  world_.follow();
  drives_.settle(of(robot), world_);
  world_.forward();
  auto within = Contacts::overlap(world_);
  if (within) stand(before);
  feel();
  if (within) return std::unexpected{std::move(*within)};
  return {};
}

void MujocoRobot::step(std::span<const double> torques, Brakes brakes, Duration span) noexcept {
  for (std::size_t i = 0; i < joints(); ++i) drive(i, i < torques.size() ? torques[i] : 0, brakes);
  step(span);
}

void MujocoRobot::step(Duration span) noexcept {
  drives_.brake(world_);
  world_.step(span);
  feel();
}

void MujocoRobot::set_mass_factor(double factor, std::size_t robot) noexcept {
  links_[robot].set_mass_factor(factor);
  RobotLinks::weigh(world_, links_);
}
void MujocoRobot::set_inertia_factor(double factor, std::size_t robot) noexcept {
  links_[robot].set_inertia_factor(factor);
  RobotLinks::weigh(world_, links_);
}
void MujocoRobot::set_payload(double mass_kg, std::size_t robot) noexcept {
  links_[robot].set_payload(mass_kg);
  RobotLinks::weigh(world_, links_);
}
void MujocoRobot::set_rotors(std::span<const double> inertias, std::size_t robot) noexcept {
  drives_.set_rotors(inertias.first(std::min(inertias.size(), joints(robot))), of(robot).first_joint, world_);
  RobotLinks::weigh(world_, links_);
}

}  // namespace hirosco::simulation
