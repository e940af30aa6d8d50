// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "simulation/mujoco/mujoco_spec.hpp"

/// Gears that give way: behind what a drive moves, a spring and a damper, and then the link (docs/adr/0182). Both are joints of one body about one
/// axis: the first is the drive's, with rotor, friction and brake, the second the spring.
namespace hirosco::simulation {

std::expected<MujocoSpec, std::string> MujocoSpec::giving_way(std::span<const Spring> springs,
                                                              std::size_t robot) const {
  auto copy = copied();
  if (!copy) return copy;
  const Robot& its = robots_[robot];
  for (std::size_t i = 0; i < std::min(springs.size(), its.joints); ++i) {
    if (!(springs[i].stiffness > 0)) continue;
    const std::string& name = joints_[its.first_joint + i].name;
    mjsElement* element = mjs_findElement(copy->spec_.get(), mjOBJ_JOINT, name.c_str());
    mjsJoint* drive = element != nullptr ? mjs_asJoint(element) : nullptr;
    if (drive == nullptr) return std::unexpected{fmt::format("MuJoCo has no joint '{}'", name)};
    mjsBody* body = mjs_getParent(element);
    mjsElement* first = mjs_firstChild(body, mjOBJ_JOINT, 0);
    if (mjs_nextChild(body, first, 0) != nullptr)
      return std::unexpected{
          fmt::format("what joint '{}' moves is moved by another one, too, or gives way already", name)};
    if (!(springs[i].rotor > 0))
      return std::unexpected{
          fmt::format("a spring at joint '{}' has nothing on its drive's side: rotors before springs, above 0", name)};
    drive->armature = springs[i].rotor;
    mjsJoint& spring = *mjs_addJoint(body, nullptr);
    mjs_setName(spring.element, (name + spring_mark).c_str());
    spring.type = drive->type;
    std::ranges::copy(drive->pos, spring.pos);
    std::ranges::copy(drive->axis, spring.axis);
    // Nothing of a file's defaults: what else a joint has is the drive's.
    std::ranges::fill(spring.stiffness, 0.0);
    std::ranges::fill(spring.damping, 0.0);
    spring.stiffness[0] = springs[i].stiffness;
    spring.damping[0] = springs[i].damping;
    spring.springref = spring.ref = spring.armature = spring.frictionloss = 0;
    spring.limited = mjLIMITED_FALSE;
    ++copy->further_dofs_;
  }
  return copy;
}

}  // namespace hirosco::simulation
