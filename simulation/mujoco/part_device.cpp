// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/part_device.hpp"

#include <utility>

#include <fmt/format.h>

#include "simulation/mujoco/robot_files.hpp"

namespace hirosco::simulation {

PartDevice::PartDevice(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : SimulatedDevice{flows, std::move(address), settings},
      whole_{dynamic_cast<MujocoDevice*>(settings.in_world_of)},
      bus_{settings.seed} {}

Result<> PartDevice::make_world() {
  if (whole_ == nullptr || !whole_->has_world())
    return fail(ErrorCode::Unavailable, "it is in the world of a device of hirosco-sim-mujoco, and there is none");
  whole_->share();
  return ok();
}

std::vector<std::string> PartDevice::remarks() const {
  if (bus_.joints().empty() && !robot_)
    return {
        "it has no joints in its world, and its subsystem will find it silent: setting joints names them, or mount "
        "brings a robot"};
  if (!robot_) return {};
  const MujocoRobot& robot = std::as_const(*whole_).robot();
  auto remarks = RobotLines::remarks(robot, *robot_);
  if (auto within = robot.overlap()) remarks.push_back(*within + ", and will be thrown out");
  return remarks;
}

void PartDevice::advance(Duration) noexcept { bus_.drive(whole_->robot(), output()); }

void PartDevice::do_heal() noexcept {
  bus_.set_noise(0);
  if (robot_) whole_->robot().push(0, 0, 0, *robot_);
}

std::unexpected<Error> PartDevice::refuse(ErrorCode code, std::string why) {
  problem_ = std::move(why);
  return fail(code, problem_.c_str());
}

Result<> PartDevice::mount(const Words& words) {
  std::vector<std::string_view> said;
  for (std::size_t i = 1; i < words.count(); ++i) said.push_back(words[i]);
  const auto at = read_mount(said);
  if (!at) return refuse(ErrorCode::InvalidArgument, at.error());
  auto spec = read_robot(settings().files, at->name + "_");
  if (!spec) return refuse(spec.error().code, std::move(spec.error().why));
  HIROSCO_TRY_LET(robot_, whole_->mount(std::move(*spec), *at, bus_));
  return ok();
}

Result<> PartDevice::do_fault(const Words& words) {
  if (whole_ == nullptr || !whole_->has_world()) return fail(ErrorCode::Unavailable, "it has no world yet");
  if (names_robot_file(words[0])) {
    HIROSCO_TRY(words.expect(2));
    // As a <Setting> of the mission it is read when the robot is mounted.
    if (cycles() == 0 && settings().files.contains(std::string{words[0]})) return ok();
    return fail(ErrorCode::NotPermitted, "files are read when the device starts: a <Setting> of its mission");
  }
  if (words[0] == "noise") {
    constexpr double most_n_m = 100;
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(const double noise_n_m, words.number(1, 0, most_n_m));
    bus_.set_noise(noise_n_m);
    return ok();
  }
  if (robot_ && RobotLines::knows(words[0])) return lines_.take(words, whole_->robot(), *robot_);
  if (words[0] != "joints" && words[0] != "mount")
    return fail(ErrorCode::InvalidArgument, "not known here: what stands in its world is the other device's");
  if (!bus_.joints().empty() || robot_) return fail(ErrorCode::AlreadyExists, "it has its joints already");
  if (cycles() > 0) return fail(ErrorCode::NotPermitted, "joints are named before the device starts");
  if (words[0] == "mount") return mount(words);
  HIROSCO_TRY(words.expect(2));
  HIROSCO_TRY_LET(std::vector<std::size_t> joints, whole_->hand_over(words[1]));
  bus_.connect(std::move(joints));
  return ok();
}

std::string PartDevice::do_truth() const {
  if (whole_ == nullptr || !whole_->has_world()) return "no_world=1";
  const MujocoRobot& robot = std::as_const(*whole_).robot();
  std::string text;
  if (robot_)
    for (std::size_t i = 0; i < robot.joints(*robot_); ++i)
      text += RobotLines::truth_of_joint(robot, robot.first_joint(*robot_) + i, i);
  else
    for (std::size_t i = 0; i < bus_.joints().size(); ++i)
      text += RobotLines::truth_of_joint(robot, bus_.joints()[i], i);
  if (robot_) text += RobotLines::truth(robot, *robot_);
  return text + fmt::format("output={} flags={}", static_cast<int>(output()), flags());
}

}  // namespace hirosco::simulation
