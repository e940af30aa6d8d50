// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "robotics/dynamics/dynamics.hpp"
#include "robotics/urdf/robot.hpp"
#include "tests/fuzz/fuzz.hpp"

/// A URDF file from whatever octets come, with short words for the long ones of the format, so that a fuzzer comes past the syntax. What is
/// refused has a problem with a place and a hint; what is taken is one tree, and a model whose figures are numbers.
namespace {

using namespace hirosco;
using namespace hirosco::robotics;

using fuzz::expect;

/// One octet for each part of a file; what has none stands for itself.
[[nodiscard]] std::string spelled(std::string_view octets) {
  static constexpr std::string_view words[] = {"<link name=\"",
                                               "<inertial><mass value=\"",
                                               "\"/><inertia ixx=\"",
                                               "\" ixy=\"",
                                               "\" ixz=\"0\" iyy=\"",
                                               "\" iyz=\"0\" izz=\"",
                                               "\"/></inertial>",
                                               "</link>",
                                               "<joint name=\"",
                                               "\" type=\"revolute\">",
                                               "\" type=\"continuous\">",
                                               "\" type=\"prismatic\">",
                                               "\" type=\"fixed\">",
                                               "<parent link=\"",
                                               "<child link=\"",
                                               "<axis xyz=\"",
                                               "<origin xyz=\"",
                                               "\" rpy=\"",
                                               "<limit velocity=\"1\" effort=\"1\" lower=\"",
                                               "\" upper=\"",
                                               "<mimic joint=\"",
                                               "\" multiplier=\"",
                                               "\" offset=\"",
                                               "<dynamics damping=\"",
                                               "\"/>",
                                               "\">",
                                               "</joint>",
                                               "<visual/>",
                                               "\" friction=\"",
                                               "\" acceleration=\"",
                                               "\" deceleration=\"",
                                               "\" jerk=\""};
  std::string text = "<robot name=\"r\">";
  for (const char c : octets) {
    const auto octet = static_cast<unsigned char>(c);
    if (octet >= 128 && octet - 128U < std::size(words)) text += words[octet - 128U];
    else text += c;
  }
  return text + "</robot>";
}

void check_refused(const descriptor::Reading<urdf::Robot>& reading) {
  expect(!reading.problems.empty(), "what is refused has a problem");
  for (const auto& problem : reading.problems) {
    expect(problem.at.line > 0 && problem.at.column > 0, "a problem has a place");
    expect(problem.code.size() == 5 && !problem.message.empty() && !problem.hint.empty(),
           "a problem says what and what to do");
  }
}

void check_taken(const urdf::Robot& robot) {
  fuzz::taken();
  std::set<std::string_view> names;
  std::set<std::size_t> children;
  for (const auto& link : robot.links) expect(names.insert(link.name).second, "names of links differ");
  for (const auto& joint : robot.joints) {
    expect(joint.parent < robot.links.size() && children.insert(joint.child).second, "a link has one joint above it");
    expect(!joint.limits.lower || *joint.limits.lower <= *joint.limits.upper, "limits are in order");
    for (const auto& limit : {joint.limits.acceleration, joint.limits.jerk})
      expect(!limit || *limit > 0, "a joint can speed up");
    expect(joint.damping >= 0 && joint.friction >= 0, "nothing drives a joint");
    expect(!joint.mimic || (joint.mimic->joint < robot.joints.size() && !robot.joints[joint.mimic->joint].mimic),
           "who is mimicked moves by itself");
  }
  expect(children.size() + 1 == robot.links.size() && !children.contains(robot.root), "one tree");
  const auto model = Model::make(urdf::describe(robot));
  expect(model.has_value(), "a model can be made of what is taken");
  Dynamics dynamics{*model, Base::Fixed};
  MassMatrix mass;
  dynamics.mass_matrix(mass);
  expect(mass.allFinite(), "the mass matrix is of numbers");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view octets{reinterpret_cast<const char*>(data), size};
  for (const std::string& text : {std::string{octets}, spelled(octets)}) {
    const auto reading = urdf::read("fuzzed.urdf", text);
    if (reading.value) check_taken(*reading.value);
    else check_refused(reading);
  }
  return 0;
}
