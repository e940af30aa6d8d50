// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/manipulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "subsystems/manipulator/control_law.hpp"
#include "subsystems/manipulator/manipulator_data.hpp"
#include "subsystems/manipulator/motion.hpp"
#include "subsystems/manipulator/script.hpp"

namespace hirosco {
namespace {

using manipulator::ClutchValues;
using manipulator::CurrentValues;
using manipulator::GainValues;
using manipulator::Joints;
using manipulator::JoystickState;
using manipulator::RobotInput;
using manipulator::RobotOutput;
using manipulator::ScriptValues;
using manipulator::TorqueVerdict;
using manipulator::TrajectoryValues;

/// Author's failure codes of manipulator.xml: why a function was refused or ended without its effect.
constexpr auto goal_not_reached = static_cast<pus::FailureCode>(0x8001);
constexpr auto too_fast = static_cast<pus::FailureCode>(0x8002);
constexpr auto torque_tripped = static_cast<pus::FailureCode>(0x8003);
constexpr auto too_hot = static_cast<pus::FailureCode>(0x8004);
constexpr auto load_above_limit = static_cast<pus::FailureCode>(0x8005);
constexpr auto actuators_inhibited = static_cast<pus::FailureCode>(0x8006);
constexpr auto limits_not_ordered = static_cast<pus::FailureCode>(0x8007);

class Manipulator final : public Subsystem {
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
    publish("GOAL_TOLERANCE", goal_tolerance_);
    publish("GAINS", gain_values_);
    require_link("JOYSTICK_STATE", joystick_);
    require_link("REMOTE_JOYSTICK", remote_joystick_);
    use_device("ROBOT", robot_);
    on_function("MOVE_TO", [this](double q1, double q2, double duration_s, Call call) {
      return move({q1, q2}, duration_s, call);
    });
    on_function("HOME", [this](Call call) {
      const double shortest_s =
          manipulator::shortest_duration_s(desired_position_.load(), home_rad, manipulator::path_limits);
      return move(home_rad, std::max(home_duration_s, shortest_s), call);
    });
    on_function("HOLD", [this]() -> Outcome {
      if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
      if (!moving_) return refused(actuators_inhibited);
      stop_motion(pus::FailureCode::Aborted);
      return ok();
    });
    on_function("HOOK_SPRING", [this](std::uint8_t spring, Call call) { return hook(spring, call); });
    on_function("RELEASE_SPRING", [this](Call call) { return release(call); });
    on_function("RUN_SCRIPT", [this](std::uint8_t script, Call call) { return run_script(script, call); });
    on_function("SET_GAINS", [this](double kp, double kd, Call call) { return set_gains(kp, kd, call); });
    on_function("SET_TORQUE_LIMIT", [this](double limit_n_m) { return set_torque_limit(limit_n_m); });
    on_function("SET_TEMP_LIMITS", [this](double warning_c, double critical_c, double maximum_c) -> Outcome {
      if (!(warning_c < critical_c && critical_c < maximum_c)) return refused(limits_not_ordered);
      temperature_limits_.store(
          {static_cast<float>(warning_c), static_cast<float>(critical_c), static_cast<float>(maximum_c)});
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
    for (auto* call : {&move_, &script_call_, &spring_call_, &gains_call_}) call->reset();
    moving_ = false;
    told_torque_ = TorqueVerdict::Fine;
    torque_guard_.reset();
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
      stop_motion(why_stopped());
      engage();
    }
    rest();
    control(cycle);
    check_torque(cycle);
    return ok();
  }

  Result<> operational(const Cycle& cycle) noexcept override {
    measure(cycle);
    if (cycle.first) {
      engage();
      told_torque_ = TorqueVerdict::Fine;
      torque_guard_.reset();
    }
    if (!cycle.active) {
      stop_motion(why_stopped());  // inhibited it could never end
      rest();
    } else if (coupled_) {
      follow();
    } else if (script_call_) {
      advance_script(cycle);
    } else {
      advance_motion(cycle);
    }
    if (cycle.active) govern(cycle);
    watch_spring();
    control(cycle);
    check_torque(cycle);
    if (temperature_ >= manipulator::TemperatureVerdict::Critical) inhibit_actuators();
    moving_ = cycle.active && told_torque_ == TorqueVerdict::Fine;
    active_.store(moving_ ? 1 : 0);
    return ok();
  }

  Result<> error_operational(const Cycle& cycle) noexcept override {
    measure(cycle);
    if (cycle.first) stop_motion(why_stopped());
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
    moving_ = false;
    check_temperature(cycle);
  }

  /// Takes the present position as the reference: entering Operational moves nothing.
  void engage() noexcept {
    rest();
    trajectory_.start(asked_, asked_, 0.0);
    following_ = false;
    engage_clutch();
  }

  void rest() noexcept {
    asked_ = robot_.input().motor_position_rad;
    controller_->reset(asked_);
    set_desired(asked_);
    governor_.reset(desired_position_.load());
    gains_.reset(wanted_gains());
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
    asked_ = clutch_.desired(operator_->value().position_rad, position_scale_.load());
  }

  void advance_motion(const Cycle& cycle) noexcept {
    asked_ = trajectory_.advance(seconds(cycle.period));
    trajectory_values_.store({trajectory_.target_rad(), trajectory_.duration_s(), trajectory_.progress()});
    if (!move_) return;
    if (!half_reported_ && trajectory_.progress() >= 0.5) {
      half_reported_ = true;
      progress(*move_, 1);
    }
    if (trajectory_.done()) arrive(move_, trajectory_.target_rad(), cycle);
  }

  /// The end of a path is not yet the goal: a motion is done when it is measured there.
  void arrive(std::optional<Call>& call, const Joints& goal_rad, const Cycle& cycle) noexcept {
    using Verdict = manipulator::Arrival::Verdict;
    const Verdict verdict =
        arrival_.judge(robot_.input().position_rad, goal_rad, goal_tolerance_.load(), seconds(cycle.period));
    if (verdict == Verdict::UnderWay) return;
    if (verdict == Verdict::There) {
      raise(motion_done);
      finish(*call);
    } else {
      abort(*call, goal_not_reached);
    }
    call.reset();
    hold();
  }

  /// Stays where the setpoint is.
  void hold() noexcept {
    asked_ = desired_position_.load();
    trajectory_.start(asked_, asked_, 0.0);
  }

  [[nodiscard]] static Joints within_range(const Joints& position_rad) noexcept {
    return {std::clamp(position_rad[0], lowest_rad[0], highest_rad[0]),
            std::clamp(position_rad[1], lowest_rad[1], highest_rad[1])};
  }

  [[nodiscard]] manipulator::Gains wanted_gains() const noexcept {
    const double effort_n_m = torque_hard_.load();
    return {kp_.load(), kd_.load(), effort_n_m, effort_n_m / 3};
  }

  /// What is asked for reaches the control law within the bounds of motion.hpp only.
  void govern(const Cycle& cycle) noexcept {
    asked_ = within_range(asked_);
    const auto bounds = manipulator::bounds_for(torque_hard_.load(), gains_.now().kp_n_m_per_rad);
    set_desired(governor_.advance(asked_, robot_.input().motor_position_rad, bounds, seconds(cycle.period)));
  }

  void set_desired(const Joints& position_rad) noexcept { desired_position_.store(within_range(position_rad)); }

  void control(const Cycle& cycle) noexcept {
    const RobotInput& in = robot_.input();
    const manipulator::Measured measured{in.motor_position_rad, in.motor_velocity_rad_per_s,
                                         in.position_rad,       in.velocity_rad_per_s,
                                         in.torque_n_m,         in.temperature_deg_c};
    const manipulator::Gains wanted = wanted_gains();
    const manipulator::Gains& gains = gains_.advance(wanted, seconds(cycle.period));
    gain_values_.store({gains.kp_n_m_per_rad, gains.kd_n_m_s_per_rad});
    if (gains_call_ && gains_.reached(wanted)) {
      finish(*gains_call_);
      gains_call_.reset();
    }
    robot_.output().spring = spring_call_ ? wanted_spring_ : in.spring;
    robot_.output().torque_n_m = controller_->motor_torque(desired_position_.load(), measured, gains);
    desired_velocity_.store(controller_->desired_velocity_rad_s());
  }

  /// Each limit is told once until the next entry into Operational; a higher one whatever a lower one did, and when the
  /// actuators are inhibited too: what goes on loading the arm then is worse, not better.
  void check_torque(const Cycle& cycle) noexcept {
    const double soft = torque_limit_.load();
    const double hard = torque_hard_.load();
    const auto finding = torque_guard_.update(robot_.input().torque_n_m, soft, hard);
    const bool is_hard = finding.verdict == TorqueVerdict::Hard;
    if (finding.verdict <= told_torque_ || (!is_hard && !cycle.active)) return;
    told_torque_ = finding.verdict;
    inhibit_actuators();
    raise(is_hard ? torque_hard_exceeded : torque_limit_exceeded,
          {static_cast<double>(finding.joint + 1), finding.value_n_m, is_hard ? hard : soft});
  }

  /// What a function that runs is told when the actuators were taken away from it.
  [[nodiscard]] pus::FailureCode why_stopped() const noexcept {
    if (told_torque_ != TorqueVerdict::Fine) return torque_tripped;
    if (temperature_ >= manipulator::TemperatureVerdict::Critical) return too_hot;
    return pus::FailureCode::Aborted;
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
    if (!moving_) return refused(actuators_inhibited);
    if (move_ || script_call_) return refused(pus::FailureCode::Busy);
    const Joints from = desired_position_.load();
    if (duration_s < manipulator::shortest_duration_s(from, target_rad, manipulator::path_limits))
      return refused(too_fast);
    trajectory_.start(from, target_rad, duration_s);
    arrival_.start();
    move_ = call;
    half_reported_ = false;
    return running;
  }

  Outcome hook(std::uint8_t spring, const Call& call) noexcept {
    if (!moving_) return refused(actuators_inhibited);
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
    if (!moving_) return refused(actuators_inhibited);
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
      hold();
    }
  }

  Outcome run_script(std::uint8_t script, const Call& call) noexcept {
    if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
    if (!scripted_) return refused(pus::FailureCode::NotPermittedNow);
    if (!moving_) return refused(actuators_inhibited);
    if (move_ || script_call_ || spring_call_) return refused(pus::FailureCode::Busy);
    if (spring_.load() != 0) return refused(pus::FailureCode::WrongStatus);
    const ScriptValues& values = script_values_.load();
    manipulator::Script::Settings settings{.speed_m_s = values.speed_m_per_s, .over_press_m = values.over_press_m};
    settings.surroundings.bump_height_m = values.bump_height_m;
    script_.start(static_cast<manipulator::Script::Id>(script), manipulator::tip(geometry_, desired_position_.load()),
                  manipulator::tip(geometry_, home_rad), settings);
    script_call_ = call;
    arrival_.start();
    reported_leg_ = 0;
    return running;
  }

  void advance_script(const Cycle& cycle) noexcept {
    asked_ = manipulator::joints_for(geometry_, script_.advance(seconds(cycle.period)));
    using Deed = manipulator::Script::Deed;
    if (script_.deed() != Deed::None && !spring_call_)
      want_spring(script_.deed() == Deed::Hook ? std::uint8_t{1} : std::uint8_t{0}, *script_call_);
    if (script_.leg() != reported_leg_ && !script_.done()) {
      reported_leg_ = script_.leg();
      progress(*script_call_, static_cast<std::uint16_t>(reported_leg_));
    }
    if (script_.done()) arrive(script_call_, home_rad, cycle);
  }

  void stop_motion(pus::FailureCode why) noexcept {
    hold();
    if (script_call_) spring_call_.reset();  // it is the same call
    for (auto* call : {&move_, &script_call_, &spring_call_}) {
      if (!*call) continue;
      abort(**call, why);
      call->reset();
    }
  }

  /// The law takes new gains over at a bounded rate: done when they are in force.
  Outcome set_gains(double kp, double kd, const Call& call) noexcept {
    if (gains_call_) return refused(pus::FailureCode::Busy);
    kp_.store(kp);
    kd_.store(kd);
    if (!moving_) return ok();  // at rest the law has them at once
    gains_call_ = call;
    return running;
  }

  /// A limit that the arm's present load exceeds already would only stop it.
  Outcome set_torque_limit(double limit_n_m) noexcept {
    const Joints& load = robot_.input().torque_n_m;
    if (!(std::max(std::abs(load[0]), std::abs(load[1])) < limit_n_m)) return refused(load_above_limit);
    torque_limit_.store(limit_n_m);
    return ok();
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
  Parameter<double> goal_tolerance_;
  Parameter<GainValues> gain_values_;
  LinkInput<JoystickState> joystick_;
  LinkInput<JoystickState> remote_joystick_;
  const LinkInput<JoystickState>* operator_{&joystick_};  ///< the one of the two that the configuration requires
  DevicePort<RobotInput, RobotOutput> robot_;

  manipulator::Geometry geometry_;
  std::optional<manipulator::JointController> controller_;
  manipulator::Trajectory trajectory_;
  manipulator::SetpointGovernor governor_{geometry_};
  manipulator::GainRamp gains_;
  manipulator::Arrival arrival_;
  Joints asked_{};  ///< by path, programme or hand; the setpoint follows within its bounds
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
  std::optional<Call> gains_call_;
  bool half_reported_{false};
  bool coupled_{false};
  bool following_{false};
  bool scripted_{false};
  bool moving_{false};  ///< what is put out reaches the actuators
  TorqueVerdict told_torque_{TorqueVerdict::Fine};
};

}  // namespace

std::unique_ptr<Subsystem> make_manipulator() { return std::make_unique<Manipulator>(); }

}  // namespace hirosco
