// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/manipulator.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "subsystems/manipulator/control_law.hpp"
#include "subsystems/manipulator/script.hpp"

namespace hirosco {
namespace {

using manipulator::Joints;

class Manipulator final : public Subsystem {
  // Structures of manipulator.xml: same members, same order.
  struct CurrentValues {
    std::int32_t state;
    Joints position_rad;
    Joints velocity_rad_per_s;
    Joints torque_n_m;
    std::array<float, 2> temperature_deg_c;
    std::uint16_t device_flags;
  };
  struct ClutchValues {
    Joints robot_rad;
    Joints handle_rad;
  };
  struct TrajectoryValues {
    Joints target_rad;
    double duration_s;
    double progress;
  };
  struct JoystickState {
    Joints position_rad;
    Joints velocity_rad_per_s;
    std::uint8_t enable;
  };
  struct RobotInput {
    Joints motor_position_rad;
    Joints motor_velocity_rad_per_s;
    Joints position_rad;
    Joints velocity_rad_per_s;
    Joints torque_n_m;
    std::array<float, 2> temperature_deg_c;
    std::uint8_t spring;  ///< hooked, 0: none
  };
  struct RobotOutput {
    Joints torque_n_m;
    std::uint8_t spring;  ///< to be hooked; the device acts on a change
  };
  struct ScriptValues {
    double speed_m_per_s;
    double over_press_m;
    double bump_height_m;
  };

  enum Event : std::uint16_t {
    motion_done = 1001,
    spring_out_of_reach = 1006,
    temperature_warning = 1010,
    temperature_critical = 1011,
    temperature_maximum = 1012,
    torque_limit_exceeded = 1020,
    torque_hard_exceeded = 1021,
  };

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    publish("DES_POSITION", desired_position_);
    publish("DES_VELOCITY", desired_velocity_);
    publish("KP", kp_);
    publish("KD", kd_);
    publish("TORQUE_LIMIT", torque_limit_);
    publish("TORQUE_HARD", torque_hard_);
    publish("TEMP_LIMITS", temperature_limits_);
    publish("POS_SCALE", position_scale_);
    publish("CLUTCH", clutch_values_);
    publish("TIP", tip_);
    publish("TRAJ", trajectory_values_);
    publish("TIP_FORCE", tip_force_);
    publish("ACTIVE", active_);
    publish("SPRING", spring_);
    publish("SCRIPT", script_values_);
    require_link("JOYSTICK_STATE", joystick_);
    require_link("REMOTE_JOYSTICK", remote_joystick_);
    use_device("ROBOT", robot_);
    on_function("MOVE_TO", [this](double q1, double q2, double duration_s, Call call) {
      return move({q1, q2}, duration_s, call);
    });
    on_function("HOME", [this](Call call) { return move(home_rad, home_duration_s, call); });
    on_function("HOLD", [this]() -> Outcome {
      if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
      stop_motion();
      return ok();
    });
    on_function("HOOK_SPRING", [this](std::uint8_t spring, Call call) { return hook(spring, call); });
    on_function("RELEASE_SPRING", [this](Call call) { return release(call); });
    on_function("RUN_SCRIPT", [this](std::uint8_t script, Call call) { return run_script(script, call); });
    on_function("SET_GAINS", [this](double kp, double kd) -> Outcome {
      kp_.store(kp);
      kd_.store(kd);
      return ok();
    });
    on_function("SET_TORQUE_LIMIT", [this](double limit_n_m) -> Outcome {
      torque_limit_.store(limit_n_m);
      return ok();
    });
    return done;
  }

  Result<> configure(const descriptor::Configuration& configuration) override {
    coupled_ = !configuration.requires_.empty();
    const bool remote = coupled_ && configuration.requires_.front().name == "REMOTE_JOYSTICK";
    operator_ = remote ? &remote_joystick_ : &joystick_;
    scripted_ = configuration.name == "SCRIPT";
    controller_.emplace(seconds(configuration.sampling));
    move_.reset();
    script_call_.reset();
    spring_call_.reset();
    temperature_ = manipulator::TemperatureVerdict::Fine;
    return ok();
  }

  Result<> pre_operational(const Cycle& cycle) noexcept override {
    measure(cycle);
    return ok();
  }

  /// The control law runs on the present position: what would be commanded is visible, nothing moves.
  Result<> safe_operational(const Cycle& cycle) noexcept override {
    measure(cycle);
    if (cycle.first) {
      stop_motion();
      engage();
    }
    rest();
    control();
    return ok();
  }

  Result<> operational(const Cycle& cycle) noexcept override {
    measure(cycle);
    if (cycle.first) engage();
    if (!cycle.active) {
      stop_motion();  // inhibited it could never end
      rest();
    } else if (coupled_) {
      follow();
    } else if (script_call_) {
      advance_script(cycle);
    } else {
      advance_motion(cycle);
    }
    watch_spring();
    control();
    check_torque(cycle);
    if (temperature_ >= manipulator::TemperatureVerdict::Critical) inhibit_actuators();
    active_.store(cycle.active && !limited_ ? 1 : 0);
    return ok();
  }

  Result<> error_operational(const Cycle& cycle) noexcept override {
    measure(cycle);
    if (cycle.first) stop_motion();
    robot_.output() = {};
    return ok();
  }

  void measure(const Cycle& cycle) noexcept {
    const RobotInput& in = robot_.input();
    current_.store({static_cast<std::int32_t>(cycle.state), in.position_rad, in.velocity_rad_per_s, in.torque_n_m,
                    in.temperature_deg_c, robot_.flags()});
    tip_.store(manipulator::tip(geometry_, in.position_rad));
    spring_.store(in.spring);
    tip_force_.store(manipulator::tip_force(geometry_, in.position_rad, in.torque_n_m));
    active_.store(0);
    check_temperature(cycle);
  }

  /// Takes the present position as the reference: entering Operational moves nothing.
  void engage() noexcept {
    const Joints here = robot_.input().motor_position_rad;
    limited_ = false;
    torque_guard_.reset();
    controller_->reset(here);
    trajectory_.start(here, here, 0.0);
    following_ = false;
    set_desired(here);
    engage_clutch();
  }

  void rest() noexcept {
    const Joints here = robot_.input().motor_position_rad;
    controller_->reset(here);
    set_desired(here);
  }

  /// From here the handle moves the setpoint: neither the handle's angle now nor a link that was away makes it jump.
  void engage_clutch() noexcept {
    clutch_.engage(desired_position_.load(), operator_->value().position_rad);
    clutch_values_.store({clutch_.joint_rad(), clutch_.handle_rad()});
  }

  void follow() noexcept {
    const bool enabled = operator_->valid() && operator_->value().enable != 0;
    if (enabled && !following_) engage_clutch();
    following_ = enabled;
    if (!enabled) return;  // hold the last setpoint
    set_desired(clutch_.desired(operator_->value().position_rad, position_scale_.load()));
  }

  void advance_motion(const Cycle& cycle) noexcept {
    set_desired(trajectory_.advance(seconds(cycle.period)));
    trajectory_values_.store({trajectory_.target_rad(), trajectory_.duration_s(), trajectory_.progress()});
    if (!move_) return;
    if (!half_reported_ && trajectory_.progress() >= 0.5) {
      half_reported_ = true;
      progress(*move_, 1);
    }
    if (!trajectory_.done()) return;
    raise(motion_done);
    finish(*move_);
    move_.reset();
  }

  void set_desired(const Joints& position_rad) noexcept {
    desired_position_.store({std::clamp(position_rad[0], lowest_rad[0], highest_rad[0]),
                             std::clamp(position_rad[1], lowest_rad[1], highest_rad[1])});
  }

  void control() noexcept {
    const RobotInput& in = robot_.input();
    const manipulator::Measured measured{in.motor_position_rad, in.motor_velocity_rad_per_s,
                                         in.position_rad,       in.velocity_rad_per_s,
                                         in.torque_n_m,         in.temperature_deg_c};
    robot_.output().spring = spring_call_ ? wanted_spring_ : in.spring;
    robot_.output().torque_n_m =
        controller_->motor_torque(desired_position_.load(), measured, {kp_.load(), kd_.load()});
    desired_velocity_.store(controller_->desired_velocity_rad_s());
  }

  void check_torque(const Cycle& cycle) noexcept {
    if (!cycle.active) return;
    const Joints torque = robot_.input().torque_n_m;
    const double soft = torque_limit_.load();
    const double hard = torque_hard_.load();
    const auto finding = torque_guard_.update(torque, soft, hard);
    if (finding.verdict == manipulator::TorqueVerdict::Fine || limited_) return;
    limited_ = true;
    inhibit_actuators();
    const bool is_hard = finding.verdict == manipulator::TorqueVerdict::Hard;
    raise(is_hard ? torque_hard_exceeded : torque_limit_exceeded,
          {static_cast<double>(finding.joint + 1), finding.value_n_m, is_hard ? hard : soft});
  }

  /// Reports each level once on the way up, and again on an entry into Operational that is too early; a level is left
  /// only downwards.
  void check_temperature(const Cycle& cycle) noexcept {
    using manipulator::TemperatureVerdict;
    const auto& limits = temperature_limits_.load();
    const auto& values = robot_.input().temperature_deg_c;
    const TemperatureVerdict verdict = manipulator::judge(values, {limits[0], limits[1], limits[2]});
    const bool too_early = cycle.state == State::Operational && cycle.first && verdict >= TemperatureVerdict::Critical;
    if (verdict > temperature_ || too_early) {
      const bool second = values[1] > values[0];
      const std::uint16_t event = verdict == TemperatureVerdict::Warning    ? temperature_warning
                                  : verdict == TemperatureVerdict::Critical ? temperature_critical
                                                                            : temperature_maximum;
      raise(event, {second ? 2.0 : 1.0, static_cast<double>(values[second ? 1 : 0])});
    }
    temperature_ = verdict;
  }

  Outcome move(const Joints& target_rad, double duration_s, const Call& call) noexcept {
    if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
    if (move_ || script_call_) return refused(pus::FailureCode::Busy);
    trajectory_.start(desired_position_.load(), target_rad, duration_s);
    move_ = call;
    half_reported_ = false;
    return running;
  }

  Outcome hook(std::uint8_t spring, const Call& call) noexcept {
    if (spring_call_ || script_call_) return refused(pus::FailureCode::Busy);
    if (spring_.load() != 0) return refused(pus::FailureCode::WrongStatus);
    const double distance_m = manipulator::distance_to_spring(spring, tip_.load());
    if (!(distance_m <= manipulator::hook_reach_m)) {
      raise(spring_out_of_reach, {static_cast<double>(spring), distance_m});
      return refused(pus::FailureCode::NotPermittedNow);
    }
    want_spring(spring, call);
    return running;
  }

  Outcome release(const Call& call) noexcept {
    if (spring_call_ || script_call_) return refused(pus::FailureCode::Busy);
    if (spring_.load() == 0) return refused(pus::FailureCode::WrongStatus);
    want_spring(0, call);
    return running;
  }

  void want_spring(std::uint8_t spring, const Call& call) noexcept {
    wanted_spring_ = spring;
    spring_call_ = call;
    spring_cycles_left_ = spring_patience_cycles;
  }

  /// Waits for the device to have hooked or released what was asked for.
  void watch_spring() noexcept {
    if (!spring_call_) return;
    const bool of_script = script_call_.has_value();
    if (robot_.input().spring == wanted_spring_) {
      if (of_script) script_.deed_done();
      else finish(*spring_call_);
      spring_call_.reset();
    } else if (--spring_cycles_left_ <= 0) {
      abort(*spring_call_, pus::FailureCode::DeviceError);
      spring_call_.reset();
      if (!of_script) return;
      script_call_.reset();
      trajectory_.start(desired_position_.load(), desired_position_.load(), 0.0);
    }
  }

  Outcome run_script(std::uint8_t script, const Call& call) noexcept {
    if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
    if (!scripted_) return refused(pus::FailureCode::NotPermittedNow);
    if (move_ || script_call_ || spring_call_) return refused(pus::FailureCode::Busy);
    if (spring_.load() != 0) return refused(pus::FailureCode::WrongStatus);
    const ScriptValues& values = script_values_.load();
    manipulator::Script::Settings settings{.speed_m_s = values.speed_m_per_s, .over_press_m = values.over_press_m};
    settings.surroundings.bump_height_m = values.bump_height_m;
    script_.start(static_cast<manipulator::Script::Id>(script), manipulator::tip(geometry_, desired_position_.load()),
                  manipulator::tip(geometry_, home_rad), settings);
    script_call_ = call;
    reported_leg_ = 0;
    return running;
  }

  void advance_script(const Cycle& cycle) noexcept {
    set_desired(manipulator::joints_for(geometry_, script_.advance(seconds(cycle.period))));
    using Deed = manipulator::Script::Deed;
    if (script_.deed() != Deed::None && !spring_call_)
      want_spring(script_.deed() == Deed::Hook ? std::uint8_t{1} : std::uint8_t{0}, *script_call_);
    if (script_.done()) {
      raise(motion_done);
      finish(*script_call_);
      script_call_.reset();
      trajectory_.start(desired_position_.load(), desired_position_.load(), 0.0);
    } else if (script_.leg() != reported_leg_) {
      reported_leg_ = script_.leg();
      progress(*script_call_, static_cast<std::uint16_t>(reported_leg_));
    }
  }

  void stop_motion() noexcept {
    trajectory_.start(desired_position_.load(), desired_position_.load(), 0.0);
    for (auto* call : {&move_, &script_call_}) {
      if (!*call) continue;
      abort(**call, pus::FailureCode::Aborted);
      call->reset();
      if (call == &script_call_) spring_call_.reset();
    }
    if (!spring_call_) return;
    abort(*spring_call_, pus::FailureCode::Aborted);
    spring_call_.reset();
  }

  static constexpr Joints lowest_rad{-2.0, 0.2};
  static constexpr Joints highest_rad{1.0, 2.6};
  static constexpr Joints home_rad{-0.80, 1.60};
  static constexpr double home_duration_s = 3.0;
  static constexpr int spring_patience_cycles = 40;

  Parameter<CurrentValues> current_;
  Parameter<Joints> desired_position_;
  Parameter<Joints> desired_velocity_;
  Parameter<double> kp_, kd_, torque_limit_, torque_hard_, position_scale_;
  Parameter<std::array<float, 3>> temperature_limits_;
  Parameter<ClutchValues> clutch_values_;
  Parameter<Joints> tip_;
  Parameter<TrajectoryValues> trajectory_values_;
  Parameter<Joints> tip_force_;
  Parameter<std::uint8_t> active_;
  Parameter<std::uint8_t> spring_;
  Parameter<ScriptValues> script_values_;
  LinkInput<JoystickState> joystick_;
  LinkInput<JoystickState> remote_joystick_;
  const LinkInput<JoystickState>* operator_{&joystick_};  ///< the one of the two that the configuration requires
  DevicePort<RobotInput, RobotOutput> robot_;

  manipulator::Geometry geometry_;
  std::optional<manipulator::JointController> controller_;
  manipulator::Trajectory trajectory_;
  manipulator::Clutch clutch_;
  manipulator::TorqueLimit torque_guard_;
  manipulator::TemperatureVerdict temperature_{};
  manipulator::Script script_;
  std::size_t reported_leg_{0};
  std::optional<Call> script_call_;
  std::optional<Call> spring_call_;  ///< of the script while one runs
  std::uint8_t wanted_spring_{0};
  int spring_cycles_left_{0};
  std::optional<Call> move_;
  bool half_reported_{false};
  bool coupled_{false};
  bool following_{false};
  bool scripted_{false};
  bool limited_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_manipulator() { return std::make_unique<Manipulator>(); }

}  // namespace hirosco
