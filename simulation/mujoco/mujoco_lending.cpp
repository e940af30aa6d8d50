// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "simulation/mujoco/mujoco_device.hpp"

/// Joints of this world that are another device's.
namespace hirosco::simulation {

Result<> MujocoDevice::lend(const Words& words) {
  HIROSCO_TRY(words.expect(2));
  if (cycles() > 0) return fail(ErrorCode::NotPermitted, "joints are lent before the device starts");
  std::vector<std::size_t> joints;
  std::string_view names = words[1];
  while (!names.empty()) {
    const std::string_view name = names.substr(0, std::min(names.find(','), names.size()));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
    const auto found = robot_->joint(name);
    if (!found || std::ranges::find(own_, *found) == own_.end() || std::ranges::find(joints, *found) != joints.end())
      return refuse(ErrorCode::NotFound,
                    fmt::format("there is no joint '{}' that moves by itself and is its own", name));
    joints.push_back(*found);
  }
  if (joints.size() >= own_.size()) return fail(ErrorCode::InvalidArgument, "a device lends some of its joints");
  // In the order of the file, as in every frame.
  std::ranges::sort(joints);
  HIROSCO_TRY_LET(Lender to, Lender::open(flows_of_worlds_, words[0].substr(words[0].find('_') + 1), joints.size()));
  std::vector<std::size_t> left;
  std::ranges::set_difference(own_, joints, std::back_inserter(left));
  own_ = std::move(left);
  commanded_.assign(own_.size(), 0.0);
  lent_.push_back({std::move(joints), std::move(to)});
  return ok();
}

void MujocoDevice::hear_borrowers() noexcept {
  using Brakes = MujocoRobot::Brakes;
  for (Lent& lent : lent_) {
    const LentCommand& command = lent.to.hear();
    const bool drives = command.mode == DeviceMode::Active;
    const Brakes brakes = drives ? Brakes::Open : command.mode == DeviceMode::Stop ? Brakes::Slowing : Brakes::Closed;
    for (std::size_t i = 0; i < lent.joints.size(); ++i)
      robot_->drive(lent.joints[i], drives ? command.torques[i] : 0, brakes);
  }
}

void MujocoDevice::tell_borrowers() noexcept {
  for (Lent& lent : lent_) {
    LentState state;
    for (std::size_t i = 0; i < lent.joints.size(); ++i) {
      state.position[i] = robot_->position(lent.joints[i]);
      state.velocity[i] = robot_->velocity(lent.joints[i]);
      state.torque[i] = robot_->torque(lent.joints[i]);
    }
    lent.to.tell(state);
  }
}

}  // namespace hirosco::simulation
