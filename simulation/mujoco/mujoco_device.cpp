// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_device.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "simulation/mujoco/robot_files.hpp"
#include "simulation/mujoco/shapes.hpp"

namespace hirosco::simulation {
namespace {

/// What follows is the obstacle's name.
constexpr std::string_view obstacle_word = "obstacle_";
constexpr std::string_view body_word = "body_";
constexpr std::string_view pull_word = "pull_";

}  // namespace

MujocoDevice::MujocoDevice(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : SimulatedDevice{flows, std::move(address), settings}, bus_{settings.seed} {}

Result<> MujocoDevice::make_world() {
  auto spec = read_robot(settings().files);
  if (!spec) return refuse(spec.error().code, std::move(spec.error().why));
  auto made = MujocoRobot::make(std::move(*spec));
  if (!made) return refuse(ErrorCode::Malformed, std::move(made.error()));
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
  bus_.count(*robot_);
  if (!has_force_sensor_) return;
  force_age_ms_ = force_silent_ ? force_age_ms_ + 1e3 * seconds(cycle) : 0;
  if (!force_silent_) force_ = robot_->tip_force();
}

void MujocoDevice::write_sensors(OctetWriter& payload) noexcept {
  bus_.write_sensors(*robot_, payload);
  if (has_force_sensor_) {
    for (const double number : force_) payload.put(number);
    payload.put(static_cast<std::uint32_t>(std::min(force_age_ms_, 1e9)));
  }
  bus_.write_references(payload);
}

Result<std::vector<std::size_t>> MujocoDevice::hand_over(std::string_view names) {
  if (cycles() > 0) return fail(ErrorCode::NotPermitted, "joints are handed over before the device starts");
  JointBus* whose = nullptr;
  std::vector<std::size_t> joints;
  while (!names.empty()) {
    const std::string_view name = names.substr(0, std::min(names.find(','), names.size()));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
    const auto found = robot_->joint(name);
    const auto has = [&](const JointBus* bus) {
      return found && std::ranges::find(bus->joints(), *found) != bus->joints().end();
    };
    const auto bus = std::ranges::find_if(whole_robots_, has);
    if (bus == whole_robots_.end() || (whose != nullptr && *bus != whose) ||
        std::ranges::find(joints, *found) != joints.end())
      return refuse(ErrorCode::NotFound,
                    fmt::format("there is no joint '{}' that moves by itself and is its own", name));
    whose = *bus;
    joints.push_back(*found);
  }
  if (joints.empty() || joints.size() >= whose->joints().size())
    return fail(ErrorCode::InvalidArgument, "another device has some of its joints, not all");
  std::ranges::sort(joints);
  std::vector<std::size_t> left;
  std::ranges::set_difference(whose->joints(), joints, std::back_inserter(left));
  whose->connect(std::move(left));
  return joints;
}

Result<std::size_t> MujocoDevice::mount(MujocoSpec robot, const Mount& at, JointBus& bus) {
  if (cycles() > 0) return fail(ErrorCode::NotPermitted, "robots are mounted before the device starts");
  const auto number = robot_->mount(std::move(robot), at);
  if (!number) return refuse(ErrorCode::InvalidArgument, number.error());
  std::vector<std::size_t> its(robot_->joints(*number));
  std::iota(its.begin(), its.end(), robot_->first_joint(*number));
  bus.connect(std::move(its));
  whole_robots_.push_back(&bus);
  return *number;
}

std::unexpected<Error> MujocoDevice::refuse(ErrorCode code, std::string why) {
  problem_ = std::move(why);
  return fail(code, problem_.c_str());
}

std::vector<std::string> MujocoDevice::remarks() const {
  return robot_ ? RobotLines::remarks(*robot_, 0) : std::vector<std::string>{};
}

std::string MujocoDevice::engine() const { return fmt::format("MuJoCo-{}", mj_versionString()); }

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

/// Who reads the frames has to know of it, so that it is there from the beginning.
Result<> MujocoDevice::feel(const Words& words) {
  HIROSCO_TRY(words.expect(2));
  if (words[1] == "on" && cycles() == 0) has_force_sensor_ = true;
  else if (words[1] == "silent" && has_force_sensor_) force_silent_ = true;
  else if (words[1] == "tells" && has_force_sensor_) force_silent_ = false;
  else return fail(ErrorCode::NotPermitted, "force_sensor on is a <Setting> of its mission; with it silent or tells");
  return ok();
}

/// As the sensor: there from the beginning.
Result<> MujocoDevice::count(const Words& words) {
  if (words[1] == "forget" && words.count() == 2 && bus_.counts()) {
    bus_.forget_zeros();
    return ok();
  }
  if (cycles() > 0 || bus_.counts())
    return fail(ErrorCode::NotPermitted, "encoders MARK,... [BEGIN,...] is a <Setting> of its mission; with it forget");
  HIROSCO_TRY(words.expect(words.count() > 2 ? 3 : 2));
  const auto each = [&](std::string_view text) -> Result<std::vector<double>> {
    auto numbers = listed_numbers(text);
    if (!numbers) return refuse(ErrorCode::InvalidArgument, std::move(numbers.error()));
    if (numbers->size() != robot_->joints())
      return fail(ErrorCode::InvalidArgument, "another number of joints", static_cast<std::int64_t>(robot_->joints()));
    return std::move(*numbers);
  };
  HIROSCO_TRY_LET(std::vector<double> marks, each(words[1]));
  std::optional<std::vector<double>> begin_at;
  if (words.count() == 3) {
    HIROSCO_TRY_LET(begin_at, each(words[2]));
  }
  bus_.count_with(RelativeEncoders{std::move(marks), std::move(begin_at), settings().seed});
  return ok();
}

Result<> MujocoDevice::differ(const Words& words) {
  const std::string_view what = words[0];
  if (what == "gravity") {
    constexpr double most = 1e4;
    HIROSCO_TRY(words.expect(4));
    HIROSCO_TRY_LET(const double x, words.number(1, -most, most));
    HIROSCO_TRY_LET(const double y, words.number(2, -most, most));
    HIROSCO_TRY_LET(const double z, words.number(3, -most, most));
    robot_->set_gravity(x, y, z);
    return ok();
  }
  HIROSCO_TRY(words.expect(2));
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
  if (names_robot_file(words[0])) {
    HIROSCO_TRY(words.expect(2));
    // As a <Setting> of the mission it was read when the world was made.
    if (cycles() == 0 && settings().files.contains(std::string{words[0]})) return ok();
    return fail(ErrorCode::NotPermitted, "files are read when the device starts: a <Setting> of its mission");
  }
  if (words[0].starts_with(obstacle_word)) return stand_around(words);
  if (words[0].starts_with(body_word) || words[0].starts_with(pull_word)) return lie_around(words);
  if (words[0] == "force_sensor") return feel(words);
  if (words[0] == "encoders") return count(words);
  if (words[0] == "base") {
    if (words.count() != 2 || words[1] != "free")
      return fail(ErrorCode::InvalidArgument, "a base stands, or it is free: base free");
    auto floats = robot_->let_float();
    return floats ? ok() : refuse(ErrorCode::InvalidArgument, std::move(floats.error()));
  }
  if (RobotLines::knows(words[0])) return lines_.take(words, *robot_, 0);
  return differ(words);
}

/// What hangs on it, how heavy it is and what stands around it stays: that is how the world is, no fault.
void MujocoDevice::do_heal() noexcept {
  if (!robot_) return;
  robot_->push(0, 0, 0);
  robot_->let_go_of_bodies();
  bus_.set_noise(0);
  force_silent_ = false;
}

std::string MujocoDevice::do_truth() const {
  if (!robot_) return "no_world=1";
  std::string text;
  for (std::size_t i = 0; i < robot_->joints(); ++i) text += RobotLines::truth_of_joint(*robot_, i, i);
  if (bus_.counts())
    for (std::size_t i = 0; i < robot_->joints(); ++i)
      text += fmt::format("referenced_{}={} ", i + 1, bus_.knows_zero(i) ? 1 : 0);
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
  if (robot_->base().floats()) {
    const auto turned = robot_->tip_orientation();
    text += fmt::format("tip_qw={:.9f} tip_qx={:.9f} tip_qy={:.9f} tip_qz={:.9f} ", turned[0], turned[1], turned[2],
                        turned[3]);
  }
  return text + RobotLines::truth(*robot_, 0) + fmt::format("output={} flags={}", static_cast<int>(output()), flags());
}

}  // namespace hirosco::simulation
