// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/lent_device.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace hirosco::simulation {

LentDevice::LentDevice(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : SimulatedDevice{flows, std::move(address), settings}, flows_of_worlds_{flows} {}

Result<> LentDevice::take(OctetReader payload) noexcept {
  for (std::size_t i = 0; world_ && i < world_->joints(); ++i) {
    const double torque = payload.get<double>();
    wanted_.torques[i] = std::isfinite(torque) ? torque : 0;
  }
  if (!payload.exhausted()) return fail(ErrorCode::Malformed, "torque command size");
  return ok();
}

void LentDevice::advance(Duration) noexcept {
  if (!world_) return;
  wanted_.mode = output() == DeviceOutput::Active     ? DeviceMode::Active
                 : output() == DeviceOutput::Stopping ? DeviceMode::Stop
                                                      : DeviceMode::Off;
  world_->want(wanted_);
  told_ = world_->hear();
}

void LentDevice::write_sensors(OctetWriter& payload) noexcept {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!world_) return;
  for (const auto& numbers : {&LentState::position, &LentState::velocity, &LentState::torque})
    for (std::size_t i = 0; i < world_->joints(); ++i) payload.put(told_ != nullptr ? (told_->*numbers)[i] : none);
}

Result<> LentDevice::do_fault(const Words& words) {
  if (words[0] != "borrow")
    return fail(ErrorCode::InvalidArgument, "not known here: its world is that of the device that lends it its joints");
  HIROSCO_TRY(words.expect(3));
  HIROSCO_TRY_LET(const double joints, words.number(2, 1, static_cast<double>(most_lent_joints)));
  if (world_) return fail(ErrorCode::AlreadyExists, "it has its world already");
  HIROSCO_TRY_LET(world_, Borrower::open(flows_of_worlds_, words[1], static_cast<std::size_t>(joints)));
  return ok();
}

std::string LentDevice::do_truth() const {
  std::string text;
  for (std::size_t i = 0; told_ != nullptr && i < world_->joints(); ++i)
    text += fmt::format("q{0}={1:.6f} qd{0}={2:.6f} torque_{0}={3:.4f} ", i + 1, told_->position[i], told_->velocity[i],
                        told_->torque[i]);
  return text +
         fmt::format("world={} output={} flags={}", told_ != nullptr ? 1 : 0, static_cast<int>(output()), flags());
}

}  // namespace hirosco::simulation
