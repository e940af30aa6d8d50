// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/part_device.hpp"

#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {

PartDevice::PartDevice(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : SimulatedDevice{flows, std::move(address), settings},
      whole_{dynamic_cast<MujocoDevice*>(settings.in_world_of)},
      bus_{settings.seed} {}

Result<> PartDevice::make_world() {
  if (whole_ == nullptr || !whole_->has_world())
    return fail(ErrorCode::Unavailable, "it is in the world of a device of hirosco-sim-mujoco, and there is none");
  return ok();
}

std::vector<std::string> PartDevice::remarks() const {
  if (!bus_.joints().empty()) return {};
  return {"it has no joints in its world, and its subsystem will find it silent: setting joints names them"};
}

void PartDevice::advance(Duration) noexcept { bus_.drive(whole_->robot(), output()); }

Result<> PartDevice::do_fault(const Words& words) {
  if (whole_ == nullptr || !whole_->has_world()) return fail(ErrorCode::Unavailable, "it has no world yet");
  HIROSCO_TRY(words.expect(2));
  if (words[0] == "noise") {
    constexpr double most_n_m = 100;
    HIROSCO_TRY_LET(const double noise_n_m, words.number(1, 0, most_n_m));
    bus_.set_noise(noise_n_m);
    return ok();
  }
  if (words[0] != "joints")
    return fail(ErrorCode::InvalidArgument, "not known here: what stands in its world is the other device's");
  if (!bus_.joints().empty()) return fail(ErrorCode::AlreadyExists, "it has its joints already");
  if (cycles() > 0) return fail(ErrorCode::NotPermitted, "joints are named before the device starts");
  HIROSCO_TRY_LET(std::vector<std::size_t> joints, whole_->hand_over(words[1]));
  bus_.connect(std::move(joints));
  return ok();
}

std::string PartDevice::do_truth() const {
  if (whole_ == nullptr || !whole_->has_world()) return "no_world=1";
  const MujocoRobot& robot = std::as_const(*whole_).robot();
  std::string text;
  for (std::size_t i = 0; i < bus_.joints().size(); ++i) {
    const std::size_t joint = bus_.joints()[i];
    text += fmt::format("q{0}={1:.6f} qd{0}={2:.6f} torque_{0}={3:.4f} ", i + 1, robot.position(joint),
                        robot.velocity(joint), robot.torque(joint));
  }
  return text + fmt::format("output={} flags={}", static_cast<int>(output()), flags());
}

}  // namespace hirosco::simulation
