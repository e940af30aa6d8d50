// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/commanded_arm.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace hirosco {

using robot_arm::ForceSensor;
using robot_arm::Guidance;
using robot_arm::Homing;
using robot_arm::Lead;
using robot_arm::Trouble;
using robot_arm::UrdfArm;
using robot_arm::Yielding;

Result<> CommandedArm::bind() {
  parameters_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  bind_force_sensor();
  use_arm();
  events_.each([this](EventPort& event) { use_event(event); });
  HIROSCO_TRY_LET(const UrdfArm::Source source, known_.read(own_descriptor()));
  HIROSCO_TRY(obstacles_.read(source, known_.model(), known_.tip()));
  HIROSCO_TRY(known_.take_bounds());
  bind_motions();
  bind_settings();
  bind_laws();
  bind_lead();
  bind_homing();
  return ok();
}

void CommandedArm::stand() noexcept {
  if (homing_.in_force()) return homing_.end();
  torque_mode_.stand();
  yielding_.stand();
}

// --- functions -----------------------------------------------------------------------------------------------------------

Outcome CommandedArm::move(Begin begin, const FunctionValues& values, const Call& call) noexcept {
  if (const Outcome may = rules_.may_move(now()); may.kind == Outcome::Kind::Refused) return may;
  const Outcome begun = (guidance_.*begin)(values);
  if (begun.kind == Outcome::Kind::Refused) return begun;
  contact_watch_.arm(Yielding::Before::Stands);
  motion_ = call;
  return begun;
}

/// CHECK_ABORT, which moves nothing, keeps nobody in.
Outcome CommandedArm::leave(Begin begin, const FunctionValues& values, const Call& call) noexcept {
  if (guidance_.only_judges()) end_motion(pus::FailureCode::Aborted);
  if (!rules_.may_wait_for_rest(now())) return move(begin, values, call);
  motion_ = call;
  return guidance_.once_it_stands(begin, values);
}

Outcome CommandedArm::check_abort(const Call& call) noexcept {
  const bool operational = parameters_.current.load().state == static_cast<std::int32_t>(State::Operational);
  if (const Outcome may = rules_.may_check(now(), operational); may.kind == Outcome::Kind::Refused) return may;
  const Outcome begun = guidance_.check_abort();
  if (begun.kind != Outcome::Kind::Refused) motion_ = call;
  return begun;
}

/// Who jogs on says so before the time of what he said last is over: that is done then, and nothing stands still between them.
Outcome CommandedArm::jog(Begin begin, const FunctionValues& values, const Call& call) noexcept {
  if (!motion_ || stop_ || !guidance_.jogs(begin)) return move(begin, values, call);
  finish(*motion_);
  motion_ = call;
  return (guidance_.*begin)(values);
}

/// Who drives it on says so before the time of what he said last is over, as who jogs. Behind a contact its law is that of torques for a cycle yet: whoever
/// waits for its rest then is not driven on.
Outcome CommandedArm::drive(const FunctionValues& values, const Call& call) noexcept {
  const bool goes_on = motion_ && !stop_ && torque_mode_.drives() && !guidance_.waits();
  if (const Outcome may = goes_on ? running : rules_.may_move(now()); may.kind == Outcome::Kind::Refused) return may;
  const Outcome driven = torque_mode_.drive(values);
  if (driven.kind == Outcome::Kind::Refused) return driven;
  if (goes_on) finish(*motion_);
  else force_sensor_.arm(true);
  motion_ = call;
  return driven;
}

/// Whose descriptor has no abort path has no function of it.
void CommandedArm::bind_motions() {
  const auto bind = [this](const char* name, auto how, Begin begin) {
    on_function(name, [this, how, begin](const FunctionValues& values, Call call) {
      return (this->*how)(begin, values, call);
    });
  };
  bind("MOVE_J", &CommandedArm::move, &Guidance::move_j);
  bind("MOVE_P", &CommandedArm::move, &Guidance::move_p);
  bind("MOVE_L", &CommandedArm::move, &Guidance::move_l);
  bind("JOG_J", &CommandedArm::jog, &Guidance::jog_j);
  bind("JOG_L", &CommandedArm::jog, &Guidance::jog_l);
  bind("RETREAT", &CommandedArm::leave, &Guidance::retreat);
  bind_hold_and_stop();
  if (robot_arm::Posture::declared(own_descriptor()))
    posture_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  if (!robot_arm::AbortPath::declared(own_descriptor())) return;
  abort_path_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  bind("MOVE_ABORT", &CommandedArm::leave, &Guidance::move_abort);
  on_function("CHECK_ABORT", [this](Call call) { return check_abort(call); });
}

void CommandedArm::bind_settings() {
  on_function("SET_TORQUE_LIMIT", [this](double share) { return limits_.set_torque_limit(share); });
  on_function("SET_FORCE_LIMIT", [this](double force_n) { return limits_.set_force_limit(force_n); });
  on_function("SET_POWER_LIMIT",
              [this](double power_w, double tool_w) { return limits_.set_power_limits(power_w, tool_w); });
  on_function("KEEP_OUT", [this](const robot_arm::KeepOut& numbers) { return obstacles_.keep_out(numbers); });
  on_function("SET_CONTACT", [this](std::uint8_t reaction, double limit) -> Outcome {
    parameters_.contact.store({reaction, limit});
    contact_watch_.arm(Yielding::Before::Counts);
    return ok();
  });
  on_function("SET_PAYLOAD", [this](double mass_kg, std::array<double, 3> place_m) -> Outcome {
    return at_tip_.take_payload(mass_kg, place_m, motion_ || stop_);
  });
  on_function("SET_TOOL", [this](std::array<double, 3> place_m, std::array<double, 4> wxyz) -> Outcome {
    return at_tip_.take_tool({place_m, wxyz}, motion_ || stop_);
  });
}

/// What the descriptor does not offer, this arm does not have.
void CommandedArm::bind_laws() {
  const auto offered = [&](const char* name) { return own_descriptor().find_function(name) != nullptr; };
  if (offered("IMPEDANCE_J"))
    on_function("IMPEDANCE_J", [this](const FunctionValues& values, Call) -> Outcome {
      if (const Outcome may = rules_.may_soften(now()); may.kind == Outcome::Kind::Refused) return may;
      return yielding_.soften_joints(values);
    });
  if (offered("IMPEDANCE_L"))
    on_function("IMPEDANCE_L", [this](double stiffness_n_m, double turning_n_m, double damping) -> Outcome {
      if (const Outcome may = rules_.may_soften(now()); may.kind == Outcome::Kind::Refused) return may;
      return yielding_.soften_tool(stiffness_n_m, turning_n_m, damping);
    });
  if (offered("TORQUE_J"))
    on_function("TORQUE_J", [this](const FunctionValues& values, Call call) { return drive(values, call); });
  if (offered("FLOAT"))
    on_function("FLOAT", [this]() -> Outcome {
      if (const Outcome may = rules_.may_soften(now()); may.kind == Outcome::Kind::Refused) return may;
      return yielding_.let_go();
    });
  if (offered("POSITION_CONTROL"))
    on_function("POSITION_CONTROL", [this]() -> Outcome {
      if (const Outcome may = rules_.may_change_law(now()); may.kind == Outcome::Kind::Refused) return may;
      yielding_.harden();
      return ok();
    });
}

/// An arm whose device tells no force at its tip has what its joints feel, and nothing besides.
void CommandedArm::bind_force_sensor() {
  if (!ForceSensor::declared(own_descriptor())) return;
  drives_.take_force();
  force_sensor_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  events_.each_of_force_sensor([this](EventPort& event) { use_event(event); });
}

void CommandedArm::use_arm() {
  using namespace robotics::urdf;
  if (Homing::told(own_descriptor())) {
    drives_.take_references();
    use_device(UrdfArm::device, drives_.port(), {model_setting, tip_setting, fixed_setting, Homing::setting});
  } else {
    use_device(UrdfArm::device, drives_.port(), {model_setting, tip_setting, fixed_setting});
  }
}

/// An arm whose device tells nothing of its joints' zeros knows them; one of whose configurations none homes looks for none.
void CommandedArm::bind_homing() {
  if (!drives_.tells_references()) return;
  homing_.each_of_references([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  events_.each_of_references([this](EventPort& event) { use_event(event); });
  if (!Homing::declared(own_descriptor())) return;
  homing_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  events_.each_of_homing([this](EventPort& event) { use_event(event); });
  on_function("HOME", [this](Call call) -> Outcome {
    if (const Outcome may = rules_.may_home(now()); may.kind == Outcome::Kind::Refused) return may;
    const Outcome begun = homing_.home();
    if (begun.kind != Outcome::Kind::Refused) motion_ = call;
    return begun;
  });
}

/// An arm of whose configurations none has a set that leads follows nobody, and knows nothing of it.
void CommandedArm::bind_lead() {
  const bool by_positions = Lead::declared(own_descriptor(), Lead::positions_set);
  const bool by_speeds = Lead::declared(own_descriptor(), Lead::speeds_set);
  if (!by_positions && !by_speeds) return;
  if (by_positions) require_link(Lead::positions_set, lead_.positions());
  if (by_speeds) require_link(Lead::speeds_set, lead_.speeds());
  lead_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  events_.each_of_lead([this](EventPort& event) { use_event(event); });
  on_function("FOLLOW", [this]() -> Outcome {
    if (const Outcome may = rules_.may_move(now()); may.kind == Outcome::Kind::Refused) return may;
    if (const auto none = lead_.follow(guidance_.setpoints()))
      return refused(Trouble::not_led, none->text, none->number);
    contact_watch_.arm(Yielding::Before::Stands);
    return ok();
  });
}

}  // namespace hirosco
