// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_robot.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {

MujocoRobot::MujocoRobot(MujocoSpec spec)
    : world_{std::move(spec)}, drives_{world_.spec().joints()}, contacts_{world_.spec()} {}

std::expected<MujocoRobot, std::string> MujocoRobot::make(std::string_view urdf, const MeshSource& meshes) {
  auto spec = MujocoSpec::make(urdf, meshes);
  if (!spec) return std::unexpected{std::move(spec.error())};
  return made_of(std::move(*spec));
}

std::expected<MujocoRobot, std::string> MujocoRobot::make_in_scene(std::string_view mjcf, std::string_view urdf,
                                                                   const MeshSource& files) {
  auto joints = MujocoSpec::driven_joints(urdf);
  if (!joints) return std::unexpected{std::move(joints.error())};
  auto spec = MujocoSpec::make_scene(mjcf, std::move(*joints), files);
  if (!spec) return std::unexpected{std::move(spec.error())};
  return made_of(std::move(*spec));
}

std::expected<MujocoRobot, std::string> MujocoRobot::made_of(MujocoSpec spec) {
  MujocoRobot robot{std::move(spec)};
  if (auto built = robot.build({}, {}); !built) return std::unexpected{std::move(built.error())};
  return robot;
}

std::expected<void, std::string> MujocoRobot::build(std::span<const Obstacle> obstacles, LooseBodies bodies) {
  auto next = world_.compile(obstacles, bodies.all());
  if (!next) return std::unexpected{std::move(next.error())};
  if (auto found = drives_.find(*next->model, world_.spec()); !found) return found;
  contacts_.soften(*next->model);
  world_.become(std::move(*next));
  bodies_ = std::move(bodies);
  links_.find(world_, drives_, bodies_.first(world_.model()));
  drives_.close_brakes(world_);
  links_.weigh(world_);
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

std::expected<void, std::string> MujocoRobot::set_tip(const std::string& link) {
  if (!world_.spec().hang_payload_on(link)) return std::unexpected{fmt::format("there is no link '{}'", link)};
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

std::expected<void, std::string> MujocoRobot::place(std::span<const double> positions) {
  const Standing before{world_, bodies_};
  world_.reset();
  if (bodies_.count() > 0) {
    Standing kept{world_, bodies_};
    kept.take_bodies_of(before);
    stand(kept);
  }
  drives_.place(positions, world_);
  world_.follow();
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

void MujocoRobot::set_mass_factor(double factor) noexcept {
  links_.set_mass_factor(factor);
  links_.weigh(world_);
}
void MujocoRobot::set_inertia_factor(double factor) noexcept {
  links_.set_inertia_factor(factor);
  links_.weigh(world_);
}
void MujocoRobot::set_payload(double mass_kg) noexcept {
  links_.set_payload(mass_kg);
  links_.weigh(world_);
}
void MujocoRobot::set_rotors(std::span<const double> inertias) noexcept {
  drives_.set_rotors(inertias, world_);
  links_.weigh(world_);
}

}  // namespace hirosco::simulation
