// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/obstacles.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "robotics/shapes/collision.hpp"
#include "robotics/shapes/swept.hpp"

namespace hirosco::robot_arm {
namespace {

/// Of what gives way it is looked where it would be after this time.
constexpr double ahead_s = 0.1;

/// Where it would come to rest if it braked now. Who creeps is looked at a little farther on, so that what he comes nearer is more than a search
/// for a distance is off.
[[nodiscard]] JointVector ahead_of(const Setpoints& setpoints) noexcept {
  constexpr double least_way = 1e-4;
  const JointVector& now = setpoints.now().position;
  const JointVector way = setpoints.braked() - now;
  const double most = way.cwiseAbs().maxCoeff();
  return most > 0 && most < least_way ? JointVector{now + least_way / most * way} : JointVector{now + way};
}

}  // namespace

Result<> Obstacles::read(const UrdfArm::Source& source, const robotics::Model& model,
                         std::optional<robotics::FrameId> tip) {
  auto reading = robotics::read_collision_shapes(source.file, source.text, descriptor::file_system());
  const auto said = [](const descriptor::Diagnostic& its) {
    return fmt::format("{}:{}:{}: {}: {}", its.file.filename().string(), its.at.line, its.at.column, its.code,
                       its.message);
  };
  for (const auto& warning : reading.warnings) fmt::print(stderr, "{}\n", said(warning));
  if (!reading.value) {
    not_read_ = {ErrorCode::Malformed, said(reading.problems.front()),
                 static_cast<std::int64_t>(reading.problems.size())};
    return not_read_.error();
  }
  // It was read before: what somebody else moves is wherever it may be.
  if (const auto whole = robotics::urdf::read(source.file, source.text); whole.value)
    robotics::sweep(reading.value->hulls, *whole.value, source.standing);
  clearance_.emplace(model, reading.value->hulls, tip);
  return ok();
}

Outcome Obstacles::keep_out(const KeepOut& numbers) noexcept {
  if (!clearance_) return refused(pus::FailureCode::NotPermittedNow);
  std::array<robotics::Capsule, robotics::Clearance::most_volumes> volumes;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const double* its = numbers.data() + i * volume_numbers;
    volumes[i] = {{its[0], its[1], its[2]}, {its[3], its[4], its[5]}, its[6]};
  }
  clearance_->keep_out(volumes);
  parts_.kept_out.store(numbers);
  return ok();
}

void Obstacles::carry(const Vector3& tool_m, const Vector3& payload_m, double radius_m) noexcept {
  if (!clearance_) return;
  using Carried = robotics::Clearance::Carried;
  clearance_->carry(Carried::Tool, tool_m, radius_m);
  clearance_->carry(Carried::Payload, payload_m, radius_m);
}

void Obstacles::tell(const JointVector& position) noexcept {
  parts_.clearance_m.store(clearance_->nearest(position).distance_m);
}

std::optional<Obstacles::Nearest> Obstacles::near_at(const JointVector& posture, double noise_m) noexcept {
  const Nearest ahead = clearance_->nearer(clear_at_, posture, noise_m);
  if (ahead.distance_m == HUGE_VAL) return std::nullopt;
  return ahead;
}

std::optional<Obstacles::Nearest> Obstacles::near_on_way(const JointVector& here, const JointVector& posture,
                                                         double noise_m) noexcept {
  constexpr double nearer_share = 0.25;  // of the noise: who shakes so much does not come nearer
  if (const auto there = near_at(posture, 2 * noise_m)) return there;
  const auto there = near_at(posture, noise_m);
  if (!there || nearer(here, posture, nearer_share * noise_m).distance_m == HUGE_VAL) return std::nullopt;
  return there;
}

std::optional<Obstacles::Nearest> Obstacles::watch(const Setpoints& setpoints) noexcept {
  tell(setpoints.now().position);
  if (setpoints.at_rest() || setpoints.braking()) return std::nullopt;
  const Nearest ahead = nearer(setpoints.now().position, ahead_of(setpoints));
  if (ahead.distance_m == HUGE_VAL) return std::nullopt;
  return ahead;
}

std::optional<Obstacles::Nearest> Obstacles::watch_led(const Measured& measured) noexcept {
  tell(measured.position);
  const Nearest ahead = nearer(measured.position, measured.position + ahead_s * measured.velocity);
  if (ahead.distance_m == HUGE_VAL) return std::nullopt;
  return ahead;
}

}  // namespace hirosco::robot_arm
