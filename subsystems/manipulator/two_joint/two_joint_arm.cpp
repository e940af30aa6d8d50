// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/manipulator.hpp"
#include "subsystems/manipulator/two_joint/script.hpp"

namespace hirosco {
namespace {

using namespace manipulator::two_joint;

struct ScriptValues {  // SCRIPT in manipulator.xml
  double speed_m_per_s;
  double over_press_m;
  double bump_height_m;
};

/// The arm of the demonstrator: what it shows of its tip, its springs, its programmes.
class TwoJointArm final : public Manipulator {
 public:
  explicit TwoJointArm(manipulator::Law law) : Manipulator{std::make_unique<Contour>(Geometry{}), law} {}

 private:
  void declare() override {
    publish("TIP", tip_);
    publish("TIP_FORCE", tip_force_);
    publish("SPRING", spring_);
    publish("SCRIPT", script_values_);
    use_event(spring_out_of_reach_);
    on_function("HOOK_SPRING", [this](std::uint8_t spring, Call call) { return hook(spring, call); });
    on_function("RELEASE_SPRING", [this](Call call) { return release(call); });
    on_function("RUN_SCRIPT", [this](std::uint8_t script, Call call) { return run_script(script, call); });
  }

  Result<> configure(const descriptor::Configuration& configuration) override {
    scripted_ = configuration.name == "SCRIPT";
    if (joints() != 2) return fail(ErrorCode::Mismatch, "this arm has two joints", static_cast<std::int64_t>(joints()));
    return Manipulator::configure(configuration);
  }

  void observe(const manipulator::RobotInput& in) noexcept override {
    tip_.store(tip(geometry_, in.position_rad));
    spring_.store(in.tool);
    tip_force_.store(tip_force(geometry_, in.position_rad, in.torque_n_m));
  }

  Outcome hook(std::uint8_t spring, const Call& call) noexcept {
    if (!moving()) return refused(Trouble::actuators_inhibited);
    if (tool_in_use()) return refused(pus::FailureCode::Busy);
    if (spring_.load() != 0) return refused(pus::FailureCode::WrongStatus);
    const double distance_m = distance_to_spring(spring, tip_.load());
    if (!(distance_m <= hook_reach_m)) {
      raise(spring_out_of_reach_, spring, distance_m);
      return refused(pus::FailureCode::NotPermittedNow);
    }
    return use_tool(spring, call);
  }

  Outcome release(const Call& call) noexcept {
    if (!moving()) return refused(Trouble::actuators_inhibited);
    if (tool_in_use()) return refused(pus::FailureCode::Busy);
    if (spring_.load() == 0) return refused(pus::FailureCode::WrongStatus);
    return use_tool(0, call);
  }

  Outcome run_script(std::uint8_t script, const Call& call) noexcept {
    if (coupled()) return refused(pus::FailureCode::SetpointOwnedByLink);
    if (!scripted_) return refused(pus::FailureCode::NotPermittedNow);
    if (!moving()) return refused(Trouble::actuators_inhibited);
    if (busy()) return refused(pus::FailureCode::Busy);
    if (spring_.load() != 0) return refused(pus::FailureCode::WrongStatus);
    const ScriptValues values = script_values_.load();
    Script::Settings settings{.speed_m_s = values.speed_m_per_s, .over_press_m = values.over_press_m};
    settings.surroundings.bump_height_m = values.bump_height_m;
    script_.start(static_cast<Script::Id>(script), desired_rad(), home_rad(), settings);
    return run(script_, call);
  }

  Event<std::uint8_t, double> spring_out_of_reach_{"SPRING_OUT_OF_REACH"};  ///< spring, m
  Parameter<Point> tip_;
  Parameter<Point> tip_force_;
  Parameter<std::uint8_t> spring_;
  Parameter<ScriptValues> script_values_;
  Geometry geometry_;
  Script script_{geometry_};
  bool scripted_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_manipulator() { return make_manipulator_with(manipulator::joint_law); }
std::unique_ptr<Subsystem> make_manipulator_with(manipulator::Law law) { return std::make_unique<TwoJointArm>(law); }

}  // namespace hirosco
