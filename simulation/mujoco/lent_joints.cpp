// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/lent_joints.hpp"

#include <bit>
#include <cmath>
#include <span>
#include <utility>

namespace hirosco::simulation {
namespace {

using Frame = std::array<std::byte, max_device_frame_octets>;
constexpr std::size_t double_octets = 8;

[[nodiscard]] Result<std::unique_ptr<DataFlow>> flow_of(FlowFactory& flows, std::string_view name, std::size_t joints,
                                                        FlowSide side) {
  if (joints == 0 || joints > most_lent_joints)
    return fail(ErrorCode::OutOfRange, "joints that are lent are 1 to 16", static_cast<std::int64_t>(joints));
  return flows.open(lent_address(name), side);
}

}  // namespace

Result<Lender> Lender::open(FlowFactory& flows, std::string_view name, std::size_t joints) {
  HIROSCO_TRY_LET(auto flow, flow_of(flows, name, joints, FlowSide::Device));
  return Lender{std::move(flow), joints};
}

const LentCommand& Lender::hear() noexcept {
  Frame buffer;
  const auto received = flow_->receive(buffer);
  if (silent_ < lent_silence_cycles) ++silent_;
  if (received && received->flow == Flow::New) {
    const auto command = read_command(Octets{buffer}.first(received->octets));
    if (command && command->payload.size() == joints_ * double_octets) {
      OctetReader reader{command->payload, std::endian::little};
      command_.mode = command->mode;
      for (std::size_t i = 0; i < joints_; ++i) {
        const double torque = reader.get<double>();
        command_.torques[i] = std::isfinite(torque) ? torque : 0;
      }
      sequence_ = command->sequence;
      silent_ = 0;
    }
  }
  if (silent_ >= lent_silence_cycles) command_ = {};
  return command_;
}

void Lender::tell(const LentState& state) noexcept {
  std::array<std::byte, 3 * most_lent_joints * double_octets> payload;
  OctetWriter writer{payload, std::endian::little};
  for (const auto* numbers : {&state.position, &state.velocity, &state.torque})
    for (const double number : std::span{*numbers}.first(joints_)) writer.put(number);
  Frame frame;
  const auto written = write_status(frame, {.sequence = sequence_, .payload = writer.written()});
  // Nobody listening is no matter of the world's.
  if (written) static_cast<void>(flow_->send(*written));
}

Result<Borrower> Borrower::open(FlowFactory& flows, std::string_view name, std::size_t joints) {
  HIROSCO_TRY_LET(auto flow, flow_of(flows, name, joints, FlowSide::Subsystem));
  return Borrower{std::move(flow), joints};
}

void Borrower::want(const LentCommand& command) noexcept {
  std::array<std::byte, most_lent_joints * double_octets> payload;
  OctetWriter writer{payload, std::endian::little};
  for (const double torque : std::span{command.torques}.first(joints_)) writer.put(torque);
  Frame frame;
  const auto written =
      write_command(frame, {.mode = command.mode, .epoch = 1, .sequence = ++sequence_, .payload = writer.written()});
  if (written) static_cast<void>(flow_->send(*written));
}

const LentState* Borrower::hear() noexcept {
  Frame buffer;
  const auto received = flow_->receive(buffer);
  if (silent_ < lent_silence_cycles) ++silent_;
  if (received && received->flow == Flow::New) {
    const auto status = read_status(Octets{buffer}.first(received->octets));
    if (status && status->payload.size() == 3 * joints_ * double_octets) {
      OctetReader reader{status->payload, std::endian::little};
      for (auto* numbers : {&state_.position, &state_.velocity, &state_.torque})
        for (double& number : std::span{*numbers}.first(joints_)) number = reader.get<double>();
      silent_ = 0;
    }
  }
  return silent_ < lent_silence_cycles ? &state_ : nullptr;
}

}  // namespace hirosco::simulation
