// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "subsystems/robot_arm/control/watch.hpp"
#include "subsystems/robot_arm/floating/base_estimate.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"

namespace hirosco {

/// An arm on a base that floats: it moves its joints, or its tool in inertial axes by the pose of the base that somebody else measures.
/// What the robot is it reads from the URDF file that the setting MODEL_FILE of its device names.
class FloatingArm final : public Subsystem {
 public:
  /// Author's failure codes: why a function was refused or ended without its effect.
  enum class Trouble : std::uint16_t {
    goal_not_reached = 0x8001,
    out_of_range = 0x8002,
    limit_tripped = 0x8003,
    too_fast = 0x8004,  ///< joints or tool would be faster than they may
    another_law = 0x8005,  ///< not in this configuration
    actuators_inhibited = 0x8006,
    base_is_held = 0x8007,  ///< somebody's actuators act on the base
    ill_conditioned = 0x8008,  ///< it cannot move the tool and leave the base unturned; thousandths
  };

  FloatingArm() = default;

 private:
  // Structures of floating_arm.xml: same members, same order.
  struct CurrentValues {
    std::int32_t state;
    robot_arm::Joints position, velocity, torque;
    std::uint16_t device_flags;
  };
  struct PoseValues {
    std::array<double, 3> position_m;
    std::array<double, 4> orientation_wxyz;
  };
  struct ErrorValues {
    double position_m;
    double orientation_deg;
  };
  struct BasePose {
    std::array<double, 3> position_m;
    std::array<double, 4> orientation_wxyz;
    std::array<double, 3> rate_rad_s, velocity_m_s;
    std::uint8_t quality, free;
    std::uint32_t stamp;
  };
  struct ArmInput {
    robot_arm::Joints position, velocity, torque;
  };
  struct ArmOutput {
    robot_arm::Joints torque;
  };
  enum class Phase : std::uint8_t { Holds, JointsMove, ToolMoves, Braked };

  Result<Step> software_init() override;
  Result<> configure(const descriptor::Configuration& configuration) override;
  Result<> pre_operational(const Cycle& cycle) noexcept override;
  Result<> safe_operational(const Cycle& cycle) noexcept override;
  Result<> operational(const Cycle& cycle) noexcept override;
  Result<> error_operational(const Cycle& cycle) noexcept override;

  void publish_all();
  void bind_functions();
  [[nodiscard]] Result<> read_model();
  [[nodiscard]] Result<> take_bounds();
  [[nodiscard]] Result<> check_lengths() noexcept;

  void measure(const Cycle& cycle) noexcept;
  void follow_base() noexcept;
  void engage() noexcept;
  void advance() noexcept;
  void arrive() noexcept;
  void control() noexcept;
  void watch() noexcept;
  [[nodiscard]] bool may_act() noexcept;
  template <FailureEnumeration Code>
  void end_motion(Code why, std::int64_t number = 0) noexcept;
  [[nodiscard]] Outcome may_move() const noexcept;
  void begin(const Call& call, Phase phase, double duration_s) noexcept;
  Outcome move_joint(const FunctionValues& values, const Call& call) noexcept;
  Outcome move_tool(const std::array<double, 3>& offset_m, double duration_s, const Call& call) noexcept;
  [[nodiscard]] bool tracks() const noexcept { return law_ != robot_arm::ToolLaw::FixedBase; }

  Parameter<CurrentValues> current_;
  Parameter<PoseValues> tool_values_, base_values_;
  Parameter<ErrorValues> error_values_;
  Parameter<double> conditioning_, progress_;
  Parameter<std::uint8_t> phase_values_, active_;
  Parameter<robot_arm::Joints> desired_velocity_;
  Parameter<std::array<double, 3>> limits_;  ///< of torque, hard of torque, of speed: shares
  Parameter<double> tool_speed_m_s_, goal_tolerance_m_;
  Event<> motion_done_{"MOTION_DONE"};
  Event<double> conditioning_low_{"CONDITIONING_LOW"};
  Event<> base_held_{"BASE_IS_HELD"};
  /// Joint from 1, what was measured, the limit.
  Event<std::uint8_t, double, double> limit_exceeded_{"LIMIT_EXCEEDED"}, hard_exceeded_{"TORQUE_HARD_EXCEEDED"};
  DevicePort<ArmInput, ArmOutput> device_;
  LinkInput<BasePose> pose_;

  std::optional<robotics::Model> model_;
  robotics::FrameId tip_;
  robotics::urdf::NotRead not_read_;  ///< of its file or settings, for whoever reads the refusal
  std::vector<robot_arm::JointBounds> bounds_;
  std::optional<robot_arm::FloatingModel> floating_;
  robot_arm::ToolLaw law_{robot_arm::ToolLaw::FixedBase};
  robot_arm::Watch watch_;
  robot_arm::Measured measured_;
  robot_arm::BaseEstimate base_;
  double cycle_s_{0.001};

  Phase phase_{Phase::Holds};
  std::optional<Call> motion_;
  double moved_s_{0}, duration_s_{0}, settled_s_{0};
  robot_arm::JointVector joints_from_, joints_goal_, wanted_rates_;
  robot_arm::ToolGoal tool_goal_;
  robotics::Vector3 tool_from_{robotics::Vector3::Zero()}, tool_offset_{robotics::Vector3::Zero()};
  robotics::Matrix3 base_kept_{robotics::Matrix3::Identity()};
  robotics::Vector3 mean_left_m_{robotics::Vector3::Zero()};
  double error_m_{0};  ///< of the tool, without the noise of single samples
  bool moving_{false};  ///< what is put out reaches the joints
  bool braked_{false};  ///< by BRAKE or a finding, until the next entry into Operational
};

[[nodiscard]] std::unique_ptr<Subsystem> make_floating_arm();

}  // namespace hirosco
