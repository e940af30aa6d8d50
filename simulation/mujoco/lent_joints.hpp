// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

/// How two simulated devices share a world: one has it, and lends joints to another one by a data flow of their own. What goes over it are device
/// frames, little endian: mode and a torque of each joint there, position, velocity and torque of each back.
/// Realtime: bounded, no allocation but in open(). Thread: one.
namespace hirosco::simulation {

inline constexpr std::size_t most_lent_joints = 16;
/// Older words of either side count as none.
inline constexpr std::uint32_t lent_silence_cycles = 20;

/// Where the two meet; each flight has its own.
[[nodiscard]] inline FlowAddress lent_address(std::string_view name) {
  return {.transfer = Transfer::SharedMemory, .address = "world-" + std::string{name}};
}

/// What the borrower last wanted; Off where it says nothing.
struct LentCommand {
  DeviceMode mode{DeviceMode::Off};
  std::array<double, most_lent_joints> torques{};
};
struct LentState {
  std::array<double, most_lent_joints> position{}, velocity{}, torque{};
};

/// The side that has the world.
class Lender {
 public:
  [[nodiscard]] static Result<Lender> open(FlowFactory& flows, std::string_view name, std::size_t joints);
  /// Once in each cycle of the world.
  [[nodiscard]] const LentCommand& hear() noexcept;
  void tell(const LentState& state) noexcept;

 private:
  Lender(std::unique_ptr<DataFlow> flow, std::size_t joints) noexcept : flow_{std::move(flow)}, joints_{joints} {}
  std::unique_ptr<DataFlow> flow_;
  std::size_t joints_;
  LentCommand command_;
  std::uint32_t sequence_{0};
  std::uint32_t silent_{lent_silence_cycles};
};

/// The side whose joints they are.
class Borrower {
 public:
  [[nodiscard]] static Result<Borrower> open(FlowFactory& flows, std::string_view name, std::size_t joints);
  [[nodiscard]] std::size_t joints() const noexcept { return joints_; }
  /// Once in each cycle.
  void want(const LentCommand& command) noexcept;
  /// Null: the world says nothing.
  [[nodiscard]] const LentState* hear() noexcept;

 private:
  Borrower(std::unique_ptr<DataFlow> flow, std::size_t joints) noexcept : flow_{std::move(flow)}, joints_{joints} {}
  std::unique_ptr<DataFlow> flow_;
  std::size_t joints_;
  LentState state_;
  std::uint32_t sequence_{0};
  std::uint32_t silent_{lent_silence_cycles};
};

}  // namespace hirosco::simulation
