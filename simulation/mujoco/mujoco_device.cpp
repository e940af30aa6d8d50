// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_device.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::simulation {
namespace {

constexpr std::string_view model_setting = "MODEL_FILE";
constexpr std::string_view world_file_setting = "WORLD_FILE";
/// What follows is the obstacle's name.
constexpr std::string_view obstacle_word = "obstacle_";
constexpr std::string_view body_word = "body_";
constexpr std::string_view pull_word = "pull_";

}  // namespace

MujocoDevice::MujocoDevice(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : SimulatedDevice{flows, std::move(address), settings}, bus_{settings.seed} {}

Result<> MujocoDevice::make_world() {
  const auto& files = settings().files;
  const auto robot = files.find(std::string{model_setting}), scene = files.find(std::string{world_file_setting});
  if (robot == files.end())
    return fail(ErrorCode::NotFound, "the descriptor names no URDF file: setting MODEL_FILE of the device");
  const auto read = [](const std::filesystem::path& file) -> std::expected<std::string, std::string> {
    auto octets = descriptor::file_system()(file);
    if (!octets) return std::unexpected{octets.error().text};
    return std::move(*octets);
  };
  const auto& world = scene != files.end() ? scene->second : robot->second;
  const MeshSource beside = [&](const std::string& file) {
    return read((std::filesystem::path{world}.parent_path() / file).lexically_normal());
  };
  const auto urdf = read(robot->second);
  if (!urdf) return refuse(ErrorCode::NotFound, fmt::format("{} {}", robot->second, urdf.error()));
  const auto mjcf = scene != files.end() ? read(scene->second) : std::expected<std::string, std::string>{};
  if (!mjcf) return refuse(ErrorCode::NotFound, fmt::format("{} {}", scene->second, mjcf.error()));
  auto made =
      scene != files.end() ? MujocoRobot::make_in_scene(*mjcf, *urdf, beside) : MujocoRobot::make(*urdf, beside);
  if (!made) return refuse(ErrorCode::Malformed, fmt::format("{}: {}", world, made.error()));
  robot_.emplace(std::move(*made));
  std::vector<std::size_t> all(robot_->joints());
  std::iota(all.begin(), all.end(), std::size_t{0});
  bus_.connect(std::move(all));
  return ok();
}

void MujocoDevice::advance(Duration cycle) noexcept {
  driven_ = output() == DeviceOutput::Active;
  bus_.drive(*robot_, output());
  robot_->step(cycle);
}

Result<std::vector<std::size_t>> MujocoDevice::hand_over(std::string_view names) {
  if (cycles() > 0) return fail(ErrorCode::NotPermitted, "joints are handed over before the device starts");
  const auto own = bus_.joints();
  std::vector<std::size_t> joints;
  while (!names.empty()) {
    const std::string_view name = names.substr(0, std::min(names.find(','), names.size()));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
    const auto found = robot_->joint(name);
    if (!found || std::ranges::find(own, *found) == own.end() || std::ranges::find(joints, *found) != joints.end())
      return refuse(ErrorCode::NotFound,
                    fmt::format("there is no joint '{}' that moves by itself and is its own", name));
    joints.push_back(*found);
  }
  if (joints.empty() || joints.size() >= own.size())
    return fail(ErrorCode::InvalidArgument, "another device has some of its joints, not all");
  std::ranges::sort(joints);
  std::vector<std::size_t> left;
  std::ranges::set_difference(own, joints, std::back_inserter(left));
  bus_.connect(std::move(left));
  return joints;
}

std::unexpected<Error> MujocoDevice::refuse(ErrorCode code, std::string why) {
  problem_ = std::move(why);
  return fail(code, problem_.c_str());
}

std::vector<std::string> MujocoDevice::remarks() const {
  constexpr std::size_t most = 20;
  std::vector<std::string> remarks;
  if (!robot_) return remarks;
  for (const std::string& shape : robot_->left_out()) {
    if (remarks.size() == most) {
      remarks.push_back(fmt::format("its world leaves out {} more", robot_->left_out().size() - most));
      break;
    }
    remarks.push_back("its world leaves out " + shape);
  }
  return remarks;
}

/// A,B,...: as many as there are joints.
Result<std::vector<double>> MujocoDevice::each_joint(std::string_view text) {
  auto numbers = listed_numbers(text);
  if (!numbers) return refuse(ErrorCode::InvalidArgument, std::move(numbers.error()));
  if (numbers->size() != robot_->joints())
    return fail(ErrorCode::InvalidArgument, "another number of joints", static_cast<std::int64_t>(robot_->joints()));
  return std::move(*numbers);
}

Result<> MujocoDevice::stand_around(const Words& words) {
  const std::string_view name = words[0].substr(obstacle_word.size());
  if (name.empty()) return fail(ErrorCode::InvalidArgument, "an obstacle has a name: obstacle_NAME");
  std::vector<std::string_view> said;
  for (std::size_t i = 1; i < words.count(); ++i) said.push_back(words[i]);
  std::expected<void, std::string> done;
  if (said.size() == 1 && said.front() == "none") {
    done = robot_->take_away(name);
  } else {
    const auto obstacle = read_obstacle(name, said);
    done = obstacle ? robot_->put(*obstacle) : std::unexpected{obstacle.error()};
  }
  return done ? ok() : refuse(ErrorCode::InvalidArgument, std::move(done.error()));
}

Result<> MujocoDevice::lie_around(const Words& words) {
  const bool pulls = words[0].starts_with(pull_word);
  const std::string_view name = words[0].substr((pulls ? pull_word : body_word).size());
  if (name.empty()) return fail(ErrorCode::InvalidArgument, "a body has a name: body_NAME, pull_NAME");
  if (pulls) {
    constexpr double most_n = 1e4;
    HIROSCO_TRY(words.expect(4));
    HIROSCO_TRY_LET(const double x, words.number(1, -most_n, most_n));
    HIROSCO_TRY_LET(const double y, words.number(2, -most_n, most_n));
    HIROSCO_TRY_LET(const double z, words.number(3, -most_n, most_n));
    return robot_->pull(name, {x, y, z}) ? ok()
                                         : refuse(ErrorCode::NotFound, fmt::format("there is no body '{}'", name));
  }
  std::vector<std::string_view> said;
  for (std::size_t i = 1; i < words.count(); ++i) said.push_back(words[i]);
  std::expected<void, std::string> done;
  if (said.size() == 1 && said.front() == "none") {
    done = robot_->take_body_away(name);
  } else {
    const auto body = read_body(name, said);
    done = body ? robot_->lay(*body) : std::unexpected{body.error()};
  }
  return done ? ok() : refuse(ErrorCode::InvalidArgument, std::move(done.error()));
}

Result<> MujocoDevice::differ(const Words& words) {
  const std::string_view what = words[0];
  if (what == "friction") {
    HIROSCO_TRY_LET(const double factor, words.number(1, 0, 100));
    double more = 0;
    if (words.count() > 2) {
      HIROSCO_TRY_LET(more, words.number(2, 0, 1000));
    }
    HIROSCO_TRY(words.expect(words.count() > 2 ? 3 : 2));
    robot_->set_friction(factor, more);
    return ok();
  }
  if (what == "gravity" || what == "push") {
    constexpr double most = 1e4;
    HIROSCO_TRY(words.expect(4));
    HIROSCO_TRY_LET(const double x, words.number(1, -most, most));
    HIROSCO_TRY_LET(const double y, words.number(2, -most, most));
    HIROSCO_TRY_LET(const double z, words.number(3, -most, most));
    what == "push" ? robot_->push(x, y, z) : robot_->set_gravity(x, y, z);
    return ok();
  }
  HIROSCO_TRY(words.expect(2));
  if (what == "mass" || what == "inertia") {
    HIROSCO_TRY_LET(const double factor, words.number(1, 0.1, 10));
    what == "mass" ? robot_->set_mass_factor(factor) : robot_->set_inertia_factor(factor);
    return ok();
  }
  if (what == "payload") {
    HIROSCO_TRY_LET(const double mass_kg, words.number(1, 0, 1000));
    robot_->set_payload(mass_kg);
    return ok();
  }
  if (what == "softness") {
    HIROSCO_TRY_LET(const double time_constant_s, words.number(1, 0.001, 0.2));
    robot_->set_softness(time_constant_s);
    return ok();
  }
  if (what == "noise") {
    HIROSCO_TRY_LET(const double noise_n_m, words.number(1, 0, 100));
    bus_.set_noise(noise_n_m);
    return ok();
  }
  return fail(ErrorCode::InvalidArgument, "unknown fault");
}

Result<> MujocoDevice::do_fault(const Words& words) {
  if (!robot_) return fail(ErrorCode::Unavailable, "it has no world yet");
  if (words[0] == model_setting || words[0] == world_file_setting) {
    HIROSCO_TRY(words.expect(2));
    // As a <Setting> of the mission it was read when the world was made.
    if (cycles() == 0 && settings().files.contains(std::string{words[0]})) return ok();
    return fail(ErrorCode::NotPermitted, "files are read when the device starts: a <Setting> of its mission");
  }
  if (words[0].starts_with(obstacle_word)) return stand_around(words);
  if (words[0].starts_with(body_word) || words[0].starts_with(pull_word)) return lie_around(words);
  if (words[0] == "base") {
    if (words.count() != 2 || words[1] != "free")
      return fail(ErrorCode::InvalidArgument, "a base stands, or it is free: base free");
    auto floats = robot_->let_float();
    return floats ? ok() : refuse(ErrorCode::InvalidArgument, std::move(floats.error()));
  }
  if (words[0] == "tip") {
    HIROSCO_TRY(words.expect(2));
    auto set = robot_->set_tip(std::string{words[1]});
    return set ? ok() : refuse(ErrorCode::NotFound, std::move(set.error()));
  }
  if (words[0] == "posture" || words[0] == "rotors") {
    HIROSCO_TRY(words.expect(2));
    HIROSCO_TRY_LET(const std::vector<double> numbers, each_joint(words[1]));
    if (words[0] == "posture") {
      auto placed = robot_->place(numbers);
      return placed ? ok() : refuse(ErrorCode::InvalidArgument, std::move(placed.error()));
    }
    if (std::ranges::all_of(numbers, [](double inertia) { return inertia >= 0 && inertia < 1e3; }))
      robot_->set_rotors(numbers);
    else return fail(ErrorCode::OutOfRange, "an inertia is from 0 to 1000");
    return ok();
  }
  return differ(words);
}

/// What hangs on it, how heavy it is and what stands around it stays: that is how the world is, no fault.
void MujocoDevice::do_heal() noexcept {
  if (!robot_) return;
  robot_->push(0, 0, 0);
  robot_->let_go_of_bodies();
  bus_.set_noise(0);
}

std::string MujocoDevice::do_truth() const {
  if (!robot_) return "no_world=1";
  std::string text;
  for (std::size_t i = 0; i < robot_->joints(); ++i)
    text += fmt::format("q{0}={1:.6f} qd{0}={2:.6f} torque_{0}={3:.4f} ", i + 1, robot_->position(i),
                        robot_->velocity(i), robot_->torque(i));
  for (std::size_t i = 0; i < robot_->bodies(); ++i) {
    const auto body = robot_->body(i);
    const auto& place = body.place_m;
    const auto& turned = body.turned_wxyz;
    text += fmt::format(
        "body_{0}_x={1:.6f} body_{0}_y={2:.6f} body_{0}_z={3:.6f} body_{0}_qw={4:.6f} body_{0}_qx={5:.6f} "
        "body_{0}_qy={6:.6f} "
        "body_{0}_qz={7:.6f} body_{0}_pressed_n={8:.3f} ",
        body.name, place[0], place[1], place[2], turned[0], turned[1], turned[2], turned[3], body.pressed_n);
  }
  const auto tip = robot_->tip_m();
  const auto& touched = robot_->touched();
  if (robot_->base().floats()) {
    const auto turned = robot_->tip_orientation();
    text += fmt::format("tip_qw={:.9f} tip_qx={:.9f} tip_qy={:.9f} tip_qz={:.9f} ", turned[0], turned[1], turned[2],
                        turned[3]);
  }
  return text + fmt::format("tip_x={:.6f} tip_y={:.6f} tip_z={:.6f} contacts={} contact_n={:.3f} output={} flags={}",
                            tip[0], tip[1], tip[2], touched.contacts, touched.normal_n, static_cast<int>(output()),
                            flags());
}

}  // namespace hirosco::simulation
