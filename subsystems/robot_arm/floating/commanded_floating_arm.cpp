// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/commanded_floating_arm.hpp"

#include <array>
#include <cmath>
#include <initializer_list>
#include <span>
#include <string_view>

#include "subsystems/robot_arm/control/standing.hpp"
#include "subsystems/robot_arm/floating/floating_trouble.hpp"

namespace hirosco {

using robot_arm::JointVector;
using robot_arm::ToolLaw;
using Trouble = robot_arm::FloatingTrouble;

namespace {

constexpr const char* joints_alone = "in the configuration JOINTS only";

}  // namespace

Result<> CommandedFloatingArm::check_lengths() noexcept {
  const auto current = parameters_.current.load();
  const std::size_t joints = known_.joints();
  // Of each a number for every joint, and one besides.
  const auto of_joints = [&](const char* name) {
    const descriptor::Function* function = own_descriptor().find_function(name);
    if (function == nullptr) return joints;
    std::size_t arguments = 0;
    for (const auto& argument : function->arguments) arguments += argument.field.count;
    return arguments == 0 ? arguments : arguments - 1;
  };
  for (const std::size_t length :
       {current.position.size(), current.velocity.size(), current.torque.size(),
        parameters_.desired_velocity.load().size(),
        offers("SET_CONTACT") ? parameters_.external_torque.load().size() : joints,
        offers("IMPEDANCE_J") ? parameters_.joint_stiffness.load().size() : joints,
        offers("TORQUE_J") ? parameters_.desired_torque.load().size() : joints, drives_.says().position.size(),
        drives_.says().velocity.size(), drives_.says().torque.size(), drives_.puts_out().size(),
        of_joints("MOVE_JOINT"), of_joints("JOG_J"), of_joints("IMPEDANCE_J"), of_joints("TORQUE_J")})
    if (length != joints)
      return fail(ErrorCode::Mismatch,
                  "an array of CUR, DES_VELOCITY, EXTERNAL_TORQUE, JOINT_STIFFNESS, DES_TORQUE, MOVE_JOINT, JOG_J, "
                  "IMPEDANCE_J, TORQUE_J or ARM is not as long as the robot has joints",
                  static_cast<std::int64_t>(length));
  if (robot_arm::AbortPath::declared(own_descriptor()) && !abort_path_.has_length(joints))
    return fail(ErrorCode::Mismatch, "JOINTS of ABORT_PATH has another length than the robot has joints");
  return ok();
}

void CommandedFloatingArm::finish_call() noexcept {
  if (motion_) finish(*motion_);
  motion_.reset();
}

// --- functions -----------------------------------------------------------------------------------------------------------

Outcome CommandedFloatingArm::may_move() const noexcept {
  if (craft_.base_is_held()) return refused(Trouble::base_is_held);
  if (!moving_) return refused(Trouble::actuators_inhibited);
  if (guidance_.floats()) return refused(Trouble::led, "HOLD first");
  if (motion_ || !guidance_.holds()) return refused(pus::FailureCode::Busy);
  return running;
}

/// Whoever moves comes to rest first: to ask for no velocity at once would take more torque than limits leave.
void CommandedFloatingArm::hold() noexcept {
  if (guidance_.stops()) {  // what waits for that is called off
    if (motion_) abort(*motion_, pus::FailureCode::Aborted);
    motion_.reset();
    return guidance_.call_off();
  }
  const JointVector rates = guidance_.wanted_rates();
  const bool held = guidance_.holds();
  if (guidance_.floats()) contact_.arm(robot_arm::JointContact::Before::Counts);  // whoever led it, too
  end_motion(pus::FailureCode::Aborted);
  if (!held) guidance_.stop(rates);
  else if (!guidance_.soft()) guidance_.stand();  // springs keep to what they have
}

/// From a stand alone: who moves on the way there would go on.
Outcome CommandedFloatingArm::let_go() noexcept {
  if (moving_ && guidance_.floats()) return ok();
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  if (const auto joint = robot_arm::still_moves(drives_.measured().velocity, known_.bounds()))
    return refused(pus::FailureCode::Busy, "it moves yet and would go on: wait, joint",
                   static_cast<std::int64_t>(*joint + 1));
  guidance_.let_go();
  return ok();
}

/// What would swing faster than its law may is refused, and what was in force stays.
Outcome CommandedFloatingArm::soften(robot_arm::LawKind kind, const robot_arm::Impedance& impedance) noexcept {
  if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
  const double swings = laws_.swings_rad_s(kind, craft_.law(), impedance, craft_.model());
  // Written so that what is no number is too stiff.
  if (!(swings <= laws_.fastest_swing_rad_s()))
    return refused(Trouble::too_stiff, "it would swing with, rad/s", std::llround(swings));
  laws_.set(impedance);
  laws_.jump();
  guidance_.hold_by(kind);
  return ok();
}

/// Who comes to rest by itself is let out once it stands.
Outcome CommandedFloatingArm::may_leave() const noexcept {
  const bool waits = moving_ && !motion_ && !craft_.base_is_held() && guidance_.stops();
  return waits ? running : may_move();
}

/// CHECK_ABORT, which moves nothing, keeps nobody in.
Outcome CommandedFloatingArm::leave(Out by, double number, const Call& call) noexcept {
  if (guidance_.only_judges()) end_motion(pus::FailureCode::Aborted);
  if (const Outcome may = may_leave(); may.kind == Outcome::Kind::Refused) return may;
  return started(guidance_.leave(by, number), call);
}

/// In Safe-Operational it needs no actuators; in Operational without them nothing goes on that was begun.
Outcome CommandedFloatingArm::check_abort(const Call& call) noexcept {
  const bool operational = parameters_.current.load().state == static_cast<std::int32_t>(State::Operational);
  if (motion_) return refused(pus::FailureCode::Busy);
  if (const Outcome may = operational ? may_move() : running; may.kind == Outcome::Kind::Refused) return may;
  const Outcome begun = guidance_.check_abort();
  if (begun.kind != Outcome::Kind::Refused) motion_ = call;
  return begun;
}

Outcome CommandedFloatingArm::started(const Outcome& outcome, const Call& call) noexcept {
  if (outcome.kind == Outcome::Kind::Refused) return outcome;
  contact_.arm(robot_arm::JointContact::Before::Stands);
  motion_ = call;
  return outcome;
}

/// Who jogs on says so before the time of what he said last is over: that is done then, and nothing stands still between them.
template <class Begin>
Outcome CommandedFloatingArm::jog(bool goes_on, const Begin& begin, const Call& call) noexcept {
  const bool on = motion_ && goes_on;
  if (const Outcome may = on ? running : may_move(); may.kind == Outcome::Kind::Refused) return may;
  const Outcome begun = begin();
  if (begun.kind == Outcome::Kind::Refused) return begun;
  if (on) finish(*motion_);
  else contact_.arm(robot_arm::JointContact::Before::Stands);
  motion_ = call;
  return begun;
}

void CommandedFloatingArm::bind_functions() {
  on_function("MOVE_JOINT", [this](const FunctionValues& values, Call call) -> Outcome {
    if (craft_.tracks()) return refused(Trouble::another_law, joints_alone);
    if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
    return started(guidance_.move_joint(values), call);
  });
  on_function("MOVE_TOOL", [this](std::array<double, 3> offset_m, double duration_s, Call call) -> Outcome {
    if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
    return started(guidance_.move_tool(offset_m, duration_s), call);
  });
  on_function("HOLD", [this]() -> Outcome {
    if (!moving_) return refused(Trouble::actuators_inhibited);
    hold();
    return ok();
  });
  bind_jogs();
  bind_ways_out();
  bind_tip();
  bind_contact();
  bind_work();
  bind_laws();
  bind_lead();
  if (robot_arm::Posture::declared(own_descriptor()))
    posture_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  on_function("KEEP_OUT", [this](const robot_arm::KeepOut& numbers) { return obstacles_.keep_out(numbers); });
  on_function("BRAKE", [this]() -> Outcome {
    end_motion(pus::FailureCode::Aborted);
    braked_ = true;
    return ok();
  });
}

/// Whose descriptor does not offer them has none; so it is with all that follows.
void CommandedFloatingArm::bind_jogs() {
  if (offers("JOG_J"))
    on_function("JOG_J", [this](const FunctionValues& values, Call call) -> Outcome {
      if (craft_.tracks()) return refused(Trouble::another_law, joints_alone);
      return jog(guidance_.jogs_joints(), [&] { return guidance_.jog_joints(values); }, call);
    });
  if (offers("JOG_L"))
    on_function("JOG_L",
                [this](std::array<double, 3> moving_m_s, std::array<double, 3> turning_rad_s, double span_s,
                       Call call) -> Outcome {
                  return jog(
                      guidance_.jogs_tool(), [&] { return guidance_.jog_tool(moving_m_s, turning_rad_s, span_s); },
                      call);
                });
}

void CommandedFloatingArm::bind_tip() {
  if (!offers("SET_TOOL") && !offers("SET_PAYLOAD")) return;
  parameters_.each_of_tip([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  const auto now = [this] { return robot_arm::FloatingTip::Now{motion_.has_value(), moving_}; };
  if (offers("SET_PAYLOAD"))
    on_function("SET_PAYLOAD", [this, now](double mass_kg, std::array<double, 3> place_m) -> Outcome {
      const Outcome taken = tip_.take_payload(mass_kg, place_m, now());
      if (taken.kind != Outcome::Kind::Refused) contact_.forget();
      return taken;
    });
  if (offers("SET_TOOL"))
    on_function("SET_TOOL", [this, now](std::array<double, 3> place_m, std::array<double, 4> wxyz) -> Outcome {
      return tip_.take_tool({place_m, wxyz}, now());
    });
}

void CommandedFloatingArm::bind_contact() {
  if (offers("FLOAT")) on_function("FLOAT", [this]() -> Outcome { return let_go(); });
  if (offers("FLOAT") || offers("SET_CONTACT")) publish("FLOAT_DAMPING", parameters_.float_damping);
  if (!offers("SET_CONTACT")) return;
  parameters_.each_of_contact([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  use_event(contact_met_);
  contact_.offer();
  on_function("SET_CONTACT", [this](std::uint8_t reaction, double limit) -> Outcome {
    contact_.set(reaction, limit);
    return ok();
  });
}

/// An arm whose device tells no force at its tip has what its joints feel, and nothing besides.
void CommandedFloatingArm::bind_force_sensor() {
  if (!robot_arm::ForceSensor::declared(own_descriptor())) return;
  drives_.take_force();
  force_sensor_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  use_event(wrist_contact_);
  use_event(force_sensor_lost_);
}

/// Whose descriptor has no limits of force and power has none in force.
void CommandedFloatingArm::bind_work() {
  if (!offers("SET_FORCE_LIMIT") && !offers("SET_POWER_LIMIT")) {
    for (Parameter<double>* limit :
         {&parameters_.tool_force_limit_n, &parameters_.power_limit_w, &parameters_.tool_power_limit_w})
      limit->store(HUGE_VAL);
    return;
  }
  parameters_.each_of_work([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  for (EventPort* event : std::initializer_list<EventPort*>{&force_exceeded_, &power_exceeded_, &tool_power_exceeded_})
    use_event(*event);
  contact_.feel();
  work_.offer();
  const auto outcome = [](const std::optional<robot_arm::ToolWork::Above>& above) -> Outcome {
    if (above) return refused(Trouble::load_above_limit, above->what, std::llround(above->is));
    return ok();
  };
  if (offers("SET_FORCE_LIMIT"))
    on_function("SET_FORCE_LIMIT",
                [this, outcome](double force_n) { return outcome(work_.work().set_force_limit(force_n)); });
  if (offers("SET_POWER_LIMIT"))
    on_function("SET_POWER_LIMIT", [this, outcome](double power_w, double tool_w) {
      return outcome(work_.work().set_power_limits(power_w, tool_w));
    });
}

void CommandedFloatingArm::bind_laws() {
  using robot_arm::LawKind;
  if (offers("IMPEDANCE_J") || offers("IMPEDANCE_L") || offers("TORQUE_J"))
    parameters_.each_of_laws([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  if (offers("IMPEDANCE_J"))
    on_function("IMPEDANCE_J", [this](const FunctionValues& values, Call) -> Outcome {
      if (craft_.tracks()) return refused(Trouble::another_law, joints_alone);
      robot_arm::Impedance impedance = laws_.impedance();
      impedance.joint_n_m_rad = robot_arm::vector_of(std::span{values}.first(known_.joints()));
      impedance.damping_ratio = values[known_.joints()];
      return soften(LawKind::JointImpedance, impedance);
    });
  if (offers("IMPEDANCE_L"))
    on_function("IMPEDANCE_L", [this](double stiffness_n_m, double turning_n_m, double damping) -> Outcome {
      if (craft_.law() == ToolLaw::AttitudeHold)
        return refused(Trouble::another_law, "springs of the tool leave no base unturned");
      robot_arm::Impedance impedance = laws_.impedance();
      impedance.tool_n_m = stiffness_n_m;
      impedance.tool_n_m_rad = turning_n_m;
      impedance.damping_ratio = damping;
      return soften(LawKind::ToolImpedance, impedance);
    });
  if (offers("POSITION_CONTROL"))
    on_function("POSITION_CONTROL", [this]() -> Outcome {
      if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
      guidance_.hold_by(LawKind::Position);
      return ok();
    });
  if (!offers("TORQUE_J")) return;
  parameters_.each_of_drive([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  on_function("TORQUE_J", [this](const FunctionValues& values, Call call) -> Outcome {
    return jog(guidance_.driven(), [&] { return guidance_.drive(values); }, call);
  });
}

/// An arm of whose configurations none has a set that leads follows nobody, and knows nothing of it.
void CommandedFloatingArm::bind_lead() {
  using robot_arm::Lead;
  const bool by_positions = Lead::declared(own_descriptor(), Lead::positions_set);
  const bool by_speeds = Lead::declared(own_descriptor(), Lead::speeds_set);
  const bool by_pose = Lead::declared(own_descriptor(), robot_arm::FloatingToolLead::set);
  if (!by_positions && !by_speeds && !by_pose) return;
  const auto publish_each = [this](std::string_view name, ParameterCell& cell) { publish(name, cell); };
  if (by_positions) require_link(Lead::positions_set, lead_.positions());
  if (by_speeds) require_link(Lead::speeds_set, lead_.speeds());
  if (by_positions || by_speeds) {
    lead_.each(publish_each);
    use_event(lead_unfit_);
  }
  if (by_pose) {
    require_link(robot_arm::FloatingToolLead::set, tool_lead_.port());
    tool_lead_.each(publish_each);
    use_event(tool_lead_unfit_);
  }
  for (EventPort* event : std::initializer_list<EventPort*>{&lead_lost_, &lead_let_go_}) use_event(*event);
  on_function("FOLLOW", [this]() -> Outcome {
    if (const Outcome may = may_move(); may.kind == Outcome::Kind::Refused) return may;
    const Outcome begun = tool_lead_.leads() ? guidance_.follow(tool_lead_) : guidance_.follow(lead_);
    if (begun.kind != Outcome::Kind::Refused) contact_.arm(robot_arm::JointContact::Before::Stands);
    return begun;
  });
}

void CommandedFloatingArm::bind_ways_out() {
  // Who meets somebody may back off, too, and without RETREAT tells it where there is that event.
  if (offers("RETREAT") || own_descriptor().find_event(retracted_.name()) != nullptr) use_event(retracted_);
  if (offers("RETREAT"))
    on_function("RETREAT", [this](double distance, Call call) { return leave(Out::WayBack, distance, call); });
  if (!robot_arm::AbortPath::declared(own_descriptor())) return;
  abort_path_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  on_function("MOVE_ABORT", [this](double speed, Call call) { return leave(Out::AbortPath, speed, call); });
  on_function("CHECK_ABORT", [this](Call call) { return check_abort(call); });
}

}  // namespace hirosco
