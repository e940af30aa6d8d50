// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hirosco/xml/escaped.hpp"
#include "tools/new_folder/robot.hpp"

namespace hirosco::tools {

namespace {

using nlohmann::ordered_json;

constexpr double rotor_step = 0.1, usual_rotor_most = 10;
/// With six of them a cycle takes 100 us on a slow computer, with twelve less than three times as long; what a period has room for.
constexpr double budget_of_six_us = 200, most_budget_us = 600;
/// A goal that is a little too far is refused by the arm, which names the reason: rad or m.
constexpr double beyond_all = 0.05;
/// Of a joint that turns on and on.
constexpr double turns_rad = 6.28;
constexpr double usual_reach_m = 2;
/// Plots beside each other, and curves of one that can be told apart.
constexpr std::size_t most_joint_plots = 3, most_curves = 6;

/// What all joints have in common, or both.
[[nodiscard]] std::string unit(const robotics::Model& model, const char* turning, const char* sliding) {
  const auto slides = [](const robotics::Model::Joint& joint) { return joint.kind == robotics::JointKind::Prismatic; };
  const auto count = std::ranges::count_if(model.joints(), slides);
  if (count == 0) return turning;
  return count == model.joint_count() ? sliding : fmt::format("{}|{}", turning, sliding);
}

/// In tenths, but for light drives: nobody knows it better.
[[nodiscard]] double rotor(double effort, double most = most_rotor) {
  const double inertia = std::min(effort / effort_per_rotor, most);
  return inertia >= rotor_step / 2 ? std::round(inertia / rotor_step) * rotor_step : inertia;
}
[[nodiscard]] std::string brief(double value) { return fmt::format("{:.4g}", value); }

struct Widest {
  double lowest{0}, highest{0}, fastest{0}, strongest{0}, heaviest_rotor{0};
};
[[nodiscard]] Widest widest(const robotics::Model& model) {
  Widest all{.lowest = HUGE_VAL, .highest = -HUGE_VAL};
  for (const auto& joint : model.joints()) {
    all.lowest = std::min(all.lowest, joint.limits.lower.value_or(-turns_rad));
    all.highest = std::max(all.highest, joint.limits.upper.value_or(turns_rad));
    all.fastest = std::max(all.fastest, *joint.limits.velocity);
    all.strongest = std::max(all.strongest, *joint.limits.effort);
    all.heaviest_rotor = std::max(all.heaviest_rotor, rotor(*joint.limits.effort));
  }
  return all;
}

/// What all names begin with, up to a '_': in a picture it tells nobody apart.
[[nodiscard]] std::size_t common_beginning(const robotics::Model& model) {
  const std::string& first = model.joints().front().name;
  std::size_t common = model.joint_count() > 1 ? first.size() : 0;
  for (const auto& joint : model.joints())
    common = std::min(common, static_cast<std::size_t>(std::ranges::mismatch(first, joint.name).in1 - first.begin()));
  // Its place stands before it: "1 joint_1", where "1 1" would say nothing.
  const auto leaves_a_number = [&model](std::size_t end) {
    return std::ranges::any_of(
        model.joints(), [end](const auto& joint) { return joint.name[end + 1] >= '0' && joint.name[end + 1] <= '9'; });
  };
  std::size_t end = first.substr(0, common).rfind('_');
  while (end != std::string::npos && leaves_a_number(end)) end = first.substr(0, end).rfind('_');
  return end == std::string::npos ? 0 : end + 1;
}
/// "2 lift": its place among numbers, and its name.
[[nodiscard]] std::string shown_name(const robotics::Model& model, std::size_t joint) {
  return fmt::format("{} {}", joint + 1, model.joints()[joint].name.substr(common_beginning(model)));
}

/// As the station calls it: what is alone is no array.
[[nodiscard]] std::string element(const std::string& array, std::size_t i, std::size_t count) {
  return count == 1 ? array : fmt::format("{}[{}]", array, i);
}

[[nodiscard]] double rounded(double value) { return std::round(value * 100) / 100; }
[[nodiscard]] std::vector<double> rounded(double x, double y, double z) {
  std::vector<double> place{x, y, z};
  for (double& each : place) each = rounded(each);
  return place;
}

/// A curve of a plot; `look` may be empty.
[[nodiscard]] ordered_json curve(const std::string& name, const std::string& label, const char* look) {
  ordered_json made;
  made["name"] = name;
  made["label"] = label;
  if (*look != '\0') made["look"] = look;
  return made;
}

[[nodiscard]] ordered_json plots_of(const robotics::Model& model, const std::string& subsystem) {
  ordered_json plots = ordered_json::array();
  const std::size_t count = model.joints().size();
  for (std::size_t i = 0; i < std::min(count, most_joint_plots); ++i) {
    const auto& joint = model.joints()[i];
    ordered_json plot;
    plot["title"] = shown_name(model, i);
    if (joint.limits.lower && joint.limits.upper)
      plot["range"] = ordered_json::array({rounded(*joint.limits.lower), rounded(*joint.limits.upper)});
    plot["least"] = 0.1;
    plot["curves"].push_back(curve(element(subsystem + ".CUR_VALUES.POSITION", i, count), "is", "is"));
    plot["curves"].push_back(curve(element(subsystem + ".DES_POSITION", i, count), "set", "set"));
    plots.push_back(plot);
  }
  ordered_json torques;
  torques["title"] = "Torques";
  torques["hint"] = unit(model, "N m", "N");
  torques["least"] = 1;
  for (std::size_t i = 0; i < std::min(count, most_curves); ++i)
    torques["curves"].push_back(curve(element(subsystem + ".CUR_VALUES.TORQUE", i, count), std::to_string(i + 1), ""));
  plots.push_back(torques);
  return plots;
}

[[nodiscard]] ordered_json force_plot(const std::string& gripper) {
  ordered_json plot;
  plot["title"] = "Force of the fingers";
  plot["hint"] = "N";
  plot["least"] = 2;
  plot["curves"].push_back(curve(gripper + ".GAP.FORCE", "is", "is"));
  plot["curves"].push_back(curve(gripper + ".GAP.WANTED_FORCE", "set", "set"));
  return plot;
}

[[nodiscard]] ordered_json wrist_plot(const std::string& subsystem) {
  ordered_json plot;
  plot["title"] = "Force at the wrist";
  plot["hint"] = "N";
  plot["least"] = 1;
  for (std::size_t i = 0; i < 3; ++i)
    plot["curves"].push_back(curve(element(subsystem + ".WRIST.FORCE", i, 3), std::string(1, "xyz"[i]), ""));
  return plot;
}

/// Of the page (ground/web/README.md).
[[nodiscard]] std::string scene_of(const NewRobot& robot, const NewName& name, const Equipment& equipment) {
  ordered_json shown;
  shown["urdf"] = name.lower + ".urdf";
  shown["subsystem"] = name.upper;
  ordered_json goal, jog;
  goal["function"] = "MOVE_J";
  jog["function"] = "JOG_J";
  const std::size_t count = robot.model.joints().size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& joint = robot.model.joints()[i].name;
    shown["joints"][joint] = element(name.upper + ".CUR_VALUES.POSITION", i, count);
    shown["names"][joint] = shown_name(robot.model, i);
    goal["joints"][joint] = element("GOAL", i, count);
    jog["joints"][joint] = element("VELOCITY", i, count);
  }
  for (std::size_t i = 0; robot.hand && i < robot.hand->joints.size(); ++i) {
    const std::string& joint = robot.hand->joints[i].name;
    shown["joints"][joint] = element(name.upper + "_GRIPPER.CUR_VALUES.POSITION", i, robot.hand->joints.size());
    shown["names"][joint] = robot.hand->joints.size() == 1 ? "fingers" : fmt::format("finger {}", i + 1);
  }
  goal["speed"] = "SPEED";
  shown["goal"] = goal;
  shown["jog"] = jog;
  shown["tip"] = robot.tip;
  const double reach = robot.reach_m, middle = robot.tip_z_m / 2;
  ordered_json scene;
  scene["robots"].push_back(shown);
  scene["camera"]["fov_deg"] = 33;
  scene["camera"]["from_m"] = rounded(1.4 * reach, -1.4 * reach, middle + 0.6 * reach);
  scene["camera"]["to_m"] = rounded(0.1 * reach, 0, middle);
  scene["camera"]["above_m"] = rounded(0.1 * reach, 0, middle + 2.4 * reach);
  scene["camera"]["tip_from_m"] = rounded(0.7 * reach, -0.7 * reach, middle + 0.4 * reach);
  scene["plots"] = plots_of(robot.model, name.upper);
  if (robot.hand) scene["plots"].push_back(force_plot(name.upper + "_GRIPPER"));
  if (equipment.wrist_sensor) scene["plots"].push_back(wrist_plot(name.upper));
  return scene.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

/// us
struct Timing {
  int budget{0}, sampling{1000};
};
[[nodiscard]] Timing timing_of(const robotics::Model& model) {
  const double times = model.joint_count() / 6.0, budget = budget_of_six_us * std::max(1.0, std::pow(times, 1.5));
  Timing timing{.budget = static_cast<int>(std::ceil(budget / 50) * 50)};
  if (budget > most_budget_us) timing.sampling *= 2;
  return timing;
}

/// Of one that opens to 100 mm and presses with 40 N: 3, 10, 1 and 32 N.
constexpr double felt_share = 0.075, move_share = 0.25, least_grip_share = 0.025, most_grip_share = 0.8;
constexpr double least_force_n = 0.5, most_force_n = 1000;

/// Of all joints of the world in the order of the file.
struct Begins {
  std::vector<std::string> posture, rotors;
};
[[nodiscard]] Begins begins_of(const NewRobot& robot) {
  Begins begins;
  for (const std::string& world : robot.world_joints) {
    for (std::size_t i = 0; i < robot.model.joints().size(); ++i) {
      if (robot.model.joints()[i].name != world) continue;
      begins.posture.push_back(fmt::format("{}", robot.posture[i]));
      begins.rotors.push_back(brief(rotor(*robot.model.joints()[i].limits.effort)));
    }
    if (!robot.hand) continue;
    for (const auto& joint : robot.hand->joints) {
      if (joint.name != world) continue;
      // Nearly all open.
      const double lower = *joint.limits.lower, upper = *joint.limits.upper, in = 0.05 * (upper - lower);
      begins.posture.push_back(brief(robot.hand->closed_is_upper ? lower + in : upper - in));
      begins.rotors.push_back(brief(rotor(*joint.limits.effort, most_finger_rotor)));
    }
  }
  return begins;
}

/// Of the fingers: what stands in lines and files of the templates that robots without them do without.
void add_hand(const NewGripper& hand, std::map<std::string, std::string>& words) {
  std::vector<std::string> joints, rotors, safe;
  std::string names;
  double strongest = 0;
  for (const auto& joint : hand.joints) {
    joints.push_back(xml::escaped(joint.name));
    names += fmt::format("    <Text value=\"{}\">{}</Text>\n", joints.size(), joints.back());
    rotors.push_back(brief(rotor(*joint.limits.effort, most_finger_rotor)));
    safe.emplace_back("0");
    strongest = std::max(strongest, *joint.limits.effort);
  }
  const auto force = [&](double share) {
    return brief(std::clamp(share * hand.most_force_n, least_force_n, most_force_n));
  };
  const std::map<std::string, std::string> more{{"@hand@", ""},
                                                {"@hand_joints@", fmt::format("{}", fmt::join(joints, ","))},
                                                {"@hand_force@", brief(hand.most_force_n)},
                                                {"@fingers@", std::to_string(joints.size())},
                                                {"@finger_names@", names},
                                                {"@finger_rotors@", fmt::format("{}", fmt::join(rotors, " "))},
                                                {"@finger_safe@", fmt::format("{}", fmt::join(safe, " "))},
                                                {"@finger_strongest@", brief(strongest)},
                                                {"@closed@", hand.closed_is_upper ? "upper" : "lower"},
                                                {"@full_width@", brief(hand.full_width_m)},
                                                {"@felt_force@", force(felt_share)},
                                                {"@move_force@", force(move_share)},
                                                {"@least_force@", brief(least_force_n)},
                                                {"@least_grip@", brief(least_grip_share * hand.most_force_n)},
                                                {"@most_grip@", brief(most_grip_share * hand.most_force_n)},
                                                {"@gap_speed@", brief(hand.most_speed_m_s)},
                                                {"@grip_speed@", brief(hand.most_speed_m_s / 2)},
                                                {"@tried_grip@", brief(std::min(20.0, hand.most_force_n / 2))},
                                                {"@tried_speed@", brief(hand.most_speed_m_s / 4)}};
  words.insert(more.begin(), more.end());
}

}  // namespace

NewParts parts_of(const NewRobot& robot, const NewName& name, const Equipment& equipment) {
  const robotics::Model& model = robot.model;
  const Widest all = widest(model);
  const Timing timing = timing_of(model);
  std::string names;
  std::vector<std::string> rotors, safe;
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    const auto& joint = model.joints()[i];
    names += fmt::format("    <Text value=\"{}\">{}</Text>\n", i + 1, xml::escaped(joint.name));
    rotors.push_back(brief(rotor(*joint.limits.effort)));
    safe.emplace_back("0");
  }
  const Begins begins = begins_of(robot);
  NewParts parts{.words = {{"@robot@", robot.name},
                           {"@joints@", std::to_string(model.joint_count())},
                           {"@joint_names@", names},
                           {"@tip@", xml::escaped(robot.tip)},
                           {"@lowest@", fmt::format("{:.10g}", all.lowest - beyond_all)},
                           {"@highest@", fmt::format("{:.10g}", all.highest + beyond_all)},
                           // What is stored begins as 0, where no joint may be able to stand.
                           {"@least_stored@", fmt::format("{:.10g}", std::min(0.0, all.lowest - beyond_all))},
                           {"@most_stored@", fmt::format("{:.10g}", std::max(0.0, all.highest + beyond_all))},
                           {"@fastest@", fmt::format("{}", all.fastest)},
                           {"@strongest@", fmt::format("{}", all.strongest)},
                           {"@safe@", fmt::format("{}", fmt::join(safe, " "))},
                           {"@rotors@", fmt::format("{}", fmt::join(rotors, " "))},
                           {"@rotors_of_world@", fmt::format("{}", fmt::join(begins.rotors, ","))},
                           {"@rotors_most@", brief(std::max(usual_rotor_most, 2 * all.heaviest_rotor))},
                           {"@budget@", std::to_string(timing.budget)},
                           {"@sampling@", std::to_string(timing.sampling)},
                           {"@acceleration@", brief(robot.acceleration)},
                           {"@jerk@", brief(robot.jerk)},
                           {"@reach@", brief(std::max(usual_reach_m, std::ceil(robot.reach_m)))},
                           {"@posture@", fmt::format("{}", fmt::join(begins.posture, ","))},
                           {"@goal@", fmt::format("{}", fmt::join(robot.goal, ","))},
                           {"@place_unit@", unit(model, "rad", "m")},
                           {"@speed_unit@", unit(model, "rad/s", "m/s")},
                           {"@acceleration_unit@", unit(model, "rad/s2", "m/s2")},
                           {"@jerk_unit@", unit(model, "rad/s3", "m/s3")},
                           {"@force_unit@", unit(model, "N m", "N")},
                           {"@stiffness_unit@", unit(model, "N m/rad", "N/m")},
                           {"@inertia_unit@", unit(model, "kg m2", "kg")}},
                 .files = {{"page/newpart.urdf", robot.urdf}, {"page/scene.json", scene_of(robot, name, equipment)}}};
  for (const auto& [mesh, octets] : robot.meshes) parts.files_as_named.emplace_back("page/" + mesh, octets);
  parts.words["@meshes@"] = "";
  parts.words["@mesh_count@"] = std::to_string(robot.meshes.size());
  if (robot.meshes.empty()) parts.without_lines.emplace_back("@meshes@");
  if (robot.hand) {
    add_hand(*robot.hand, parts.words);
  } else {
    parts.without_lines.emplace_back("@hand@");
    parts.without_files.emplace_back("newpart_gripper.xml");
  }
  add_equipment(robot, equipment, name, parts);
  return parts;
}

}  // namespace hirosco::tools
