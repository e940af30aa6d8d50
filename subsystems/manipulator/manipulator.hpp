// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/manipulator/coupling.hpp"
#include "subsystems/manipulator/described_joints.hpp"
#include "subsystems/manipulator/drives.hpp"
#include "subsystems/manipulator/parameters.hpp"
#include "subsystems/manipulator/self_check.hpp"
#include "subsystems/manipulator/sensor_watch.hpp"
#include "subsystems/manipulator/servo.hpp"
#include "subsystems/manipulator/setpoint.hpp"
#include "subsystems/manipulator/tasks.hpp"
#include "subsystems/manipulator/trouble.hpp"

namespace hirosco {

/// An arm with as many joints as its descriptor has (testdata/arm.xml is one of six): stand-alone on MOVE_TO, coupled on the
/// position of a handle, or on a programme. What depends on its shape, or on where it stands, a class derived from it adds.
/// It puts its parts into the nodes of figure 4, and tells what comes of them.
class Manipulator : public Subsystem {
 public:
  /// `surface`: what the arm could run into; nullptr: nothing. `law`: how torques come from its controller.
  explicit Manipulator(std::unique_ptr<const manipulator::Surface> surface = nullptr,
                       manipulator::Law law = manipulator::joint_law) noexcept
      : surface_{std::move(surface)}, servo_{{drives_, parameters_}, law} {}

 protected:
  using Trouble = manipulator::Trouble;

  // --- what an arm of a certain shape adds ------------------------------------------------------------------------
  /// Publishes its parameters and binds its functions, in software_init().
  virtual void declare() {}
  /// Sees each sample of the sensors.
  virtual void observe(const manipulator::RobotInput&) noexcept {}

  // --- what it finds -----------------------------------------------------------------------------------------------
  [[nodiscard]] std::size_t joints() const noexcept { return joints_.count(); }
  [[nodiscard]] const manipulator::Joints& home_rad() const noexcept { return joints_.home_rad(); }
  [[nodiscard]] manipulator::Joints desired_rad() const noexcept { return setpoint_.desired_rad(); }
  [[nodiscard]] bool coupled() const noexcept { return coupled_; }
  /// What is put out reaches the actuators.
  [[nodiscard]] bool moving() const noexcept { return moving_; }
  [[nodiscard]] bool tool_in_use() const noexcept { return tasks_.tool_in_use(); }
  [[nodiscard]] bool busy() const noexcept { return tasks_.moves() || tool_in_use(); }

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
  Result<Step> self_test(const Cycle& cycle) noexcept final { return self_check_.step(cycle); }

  void bind_functions();

  void measure(const Cycle& cycle) noexcept;
  void engage() noexcept;
  void advance(const Cycle& cycle) noexcept;
  void tell(const manipulator::Tasks::News& news) noexcept;
  void control(const Cycle& cycle) noexcept;
  void check_torque(const Cycle& cycle) noexcept;
  void check_temperature(const Cycle& cycle) noexcept;
  void stop_tasks(pus::FailureCode why) noexcept;

  Outcome move(const manipulator::Joints& target_rad, double duration_s, const Call& call) noexcept;
  Outcome set_gains(double kp, double kd, const Call& call) noexcept;
  Outcome set_torque_limit(double limit_n_m) noexcept;

  manipulator::Parameters parameters_;
  Event<> motion_done_{"MOTION_DONE"};
  std::unique_ptr<const manipulator::Surface> surface_;

  // Each refers to some of those before it.
  manipulator::DescribedJoints joints_;
  manipulator::Drives drives_{parameters_};
  manipulator::Servo servo_;
  manipulator::Setpoint setpoint_{{joints_, drives_, servo_, parameters_}, surface_.get()};
  manipulator::Coupling coupling_{parameters_};
  manipulator::Tasks tasks_{{drives_, setpoint_, parameters_}};
  manipulator::SensorWatch watch_{{drives_, parameters_}};
  manipulator::SelfCheck self_check_{{joints_, drives_, servo_, setpoint_, watch_, parameters_}};
  std::optional<Call> gains_call_;
  bool coupled_{false};
  bool moving_{false};
};

/// An arm that knows nothing but its joints.
[[nodiscard]] std::unique_ptr<Subsystem> make_arm();
/// The two-joint robot of the demonstrator (paper 5), with contour, springs and programmes.
[[nodiscard]] std::unique_ptr<Subsystem> make_manipulator();
/// The same with another law.
[[nodiscard]] std::unique_ptr<Subsystem> make_manipulator_with(manipulator::Law law);

}  // namespace hirosco
