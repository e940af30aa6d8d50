// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/manipulator/control/clutch.hpp"
#include "subsystems/manipulator/control/joint_controller.hpp"
#include "subsystems/manipulator/control/programme.hpp"
#include "subsystems/manipulator/control/sensor_limits.hpp"
#include "subsystems/manipulator/control/setpoint_governor.hpp"
#include "subsystems/manipulator/manipulator_data.hpp"

namespace hirosco {

/// An arm with as many joints as its descriptor has (testdata/arm.xml is one of six): stand-alone on MOVE_TO, coupled on the
/// position of a handle, or on a programme. What depends on its shape, or on where it stands, a class derived from it adds.
class Manipulator : public Subsystem {
 public:
  /// `surface`: what the arm could run into; nullptr: nothing. `law`: how torques come from its controller.
  explicit Manipulator(std::unique_ptr<const manipulator::Surface> surface = nullptr,
                       manipulator::Law law = manipulator::joint_law) noexcept
      : surface_{std::move(surface)}, law_{law} {}

 protected:
  /// Author's failure codes: why a function was refused or ended without its effect. Each arm's descriptor names them.
  enum class Trouble : std::uint16_t {
    goal_not_reached = 0x8001,
    too_fast = 0x8002,
    torque_tripped = 0x8003,
    too_hot = 0x8004,
    load_above_limit = 0x8005,
    actuators_inhibited = 0x8006,
    limits_not_ordered = 0x8007,
  };

  // --- what an arm of a certain shape adds ------------------------------------------------------------------------
  /// Publishes its parameters and binds its functions, in software_init().
  virtual void declare() {}
  /// Sees each sample of the sensors.
  virtual void observe(const manipulator::RobotInput&) noexcept {}

  // --- what it finds -----------------------------------------------------------------------------------------------
  [[nodiscard]] std::size_t joints() const noexcept { return home_rad_.size(); }
  [[nodiscard]] const manipulator::Joints& home_rad() const noexcept { return home_rad_; }
  [[nodiscard]] manipulator::Joints desired_rad() const noexcept { return desired_position_.load(); }
  [[nodiscard]] bool coupled() const noexcept { return coupled_; }
  /// What is put out reaches the actuators.
  [[nodiscard]] bool moving() const noexcept { return moving_; }
  [[nodiscard]] bool tool_in_use() const noexcept { return tool_call_ || programme_ != nullptr; }
  [[nodiscard]] bool busy() const noexcept { return move_ || tool_in_use(); }

  // --- what it may start, while nothing else runs -------------------------------------------------------------------
  /// Until the arm is measured at the programme's goal; each leg is reported as a step. `programme` outlives it.
  Outcome run(manipulator::Programme& programme, const Call& call) noexcept;
  /// Until the device holds what is wanted, or fails to.
  Outcome use_tool(std::uint8_t wanted, const Call& call) noexcept;

  Result<> configure(const descriptor::Configuration& configuration) override;

 private:
  Result<Step> software_init() final;
  Result<> pre_operational(const Cycle& cycle) noexcept final;
  Result<> safe_operational(const Cycle& cycle) noexcept final;
  Result<> operational(const Cycle& cycle) noexcept final;
  Result<> error_operational(const Cycle& cycle) noexcept final;
  Result<Step> self_test(const Cycle& cycle) noexcept final;

  void bind_functions();
  [[nodiscard]] Result<> take_joints_of_the_descriptor();
  [[nodiscard]] Result<> check_lengths() noexcept;

  void measure(const Cycle& cycle) noexcept;
  void engage() noexcept;
  void rest() noexcept;
  void hold() noexcept;
  void engage_clutch() noexcept;
  void follow() noexcept;
  void advance_motion(const Cycle& cycle) noexcept;
  void advance_programme(const Cycle& cycle) noexcept;
  void arrive(std::optional<Call>& call, const manipulator::Joints& goal_rad, const Cycle& cycle) noexcept;
  void watch_tool() noexcept;
  void govern(const Cycle& cycle) noexcept;
  void control(const Cycle& cycle) noexcept;
  [[nodiscard]] manipulator::Measured measured() const noexcept;
  void drive(const manipulator::Joints& desired_rad, const manipulator::Measured& measured) noexcept;
  [[nodiscard]] Result<> check_sensors() noexcept;
  [[nodiscard]] Result<> check_law(std::size_t joint, double side) noexcept;
  [[nodiscard]] manipulator::Joints wish(const manipulator::Joints& desired_rad,
                                         const manipulator::Measured& measured) noexcept;
  void check_torque(const Cycle& cycle) noexcept;
  void check_temperature(const Cycle& cycle) noexcept;
  void stop_motion(pus::FailureCode why) noexcept;
  [[nodiscard]] pus::FailureCode why_stopped() const noexcept;
  [[nodiscard]] manipulator::Joints within_range(manipulator::Joints position_rad) const noexcept;
  void set_desired(const manipulator::Joints& position_rad) noexcept;
  [[nodiscard]] manipulator::Gains wanted_gains() const noexcept;

  Outcome move(const manipulator::Joints& target_rad, double duration_s, const Call& call) noexcept;
  Outcome set_gains(double kp, double kd, const Call& call) noexcept;
  Outcome set_torque_limit(double limit_n_m) noexcept;

  Parameter<manipulator::CurrentValues> current_;
  Parameter<manipulator::Joints> desired_position_, desired_velocity_;
  Event<> motion_done_{"MOTION_DONE"};
  Event<std::uint8_t, float> temperature_warning_{"TEMPERATURE_WARNING"};  // joint from 1, degC
  Event<std::uint8_t, float> temperature_critical_{"TEMPERATURE_CRITICAL"};
  Event<std::uint8_t, float> temperature_maximum_{"TEMPERATURE_MAXIMUM"};
  Event<std::uint8_t, double, double> torque_limit_exceeded_{"TORQUE_LIMIT_EXCEEDED"};  // joint from 1, N m, limit
  Event<std::uint8_t, double, double> torque_hard_exceeded_{"TORQUE_HARD_EXCEEDED"};
  Parameter<double> kp_, kd_, torque_limit_, torque_hard_, position_scale_, goal_tolerance_;
  Parameter<std::array<float, 3>> temperature_limits_;
  Parameter<manipulator::ClutchValues> clutch_values_;
  Parameter<manipulator::TrajectoryValues> trajectory_values_;
  Parameter<std::uint8_t> active_;
  Parameter<manipulator::GainValues> gain_values_;
  LinkInput<manipulator::HandleState> handle_;  ///< whichever set the configuration requires
  DevicePort<manipulator::RobotInput, manipulator::RobotOutput> robot_;

  std::unique_ptr<const manipulator::Surface> surface_;
  manipulator::Law law_;
  std::size_t tried_{0};  ///< in a self test: each joint to each side
  manipulator::Joints home_rad_, lowest_rad_, highest_rad_;  ///< the descriptor's
  std::optional<manipulator::JointController> controller_;
  manipulator::Trajectory trajectory_;
  manipulator::SetpointGovernor governor_{surface_.get()};
  manipulator::GainRamp gains_;
  manipulator::Arrival arrival_;
  manipulator::Joints asked_;  ///< by path, programme or hand; the setpoint follows within its bounds
  manipulator::Clutch clutch_;
  manipulator::TorqueGuard torque_guard_;
  manipulator::TemperatureGuard temperature_guard_;
  manipulator::ToolWatch tool_;
  manipulator::Programme* programme_{nullptr};
  std::size_t reported_leg_{0};
  std::optional<Call> programme_call_, move_, gains_call_;
  std::optional<Call> tool_call_;  ///< of the programme while one runs
  bool half_reported_{false};
  bool coupled_{false};
  bool following_{false};
  bool moving_{false};
};

/// An arm that knows nothing but its joints.
[[nodiscard]] std::unique_ptr<Subsystem> make_arm();
/// The two-joint robot of the demonstrator (paper 5), with contour, springs and programmes.
[[nodiscard]] std::unique_ptr<Subsystem> make_manipulator();
/// The same with another law.
[[nodiscard]] std::unique_ptr<Subsystem> make_manipulator_with(manipulator::Law law);

}  // namespace hirosco
