// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/aocs/aocs.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "subsystems/aocs/control/attitude_law.hpp"

namespace hirosco {
namespace {

using aocs::Quaternion;
using aocs::Vector3;

using Three = std::array<double, 3>;
using Four = std::array<double, 4>;

constexpr std::string_view wheels_device = "BASE.WHEELS";
constexpr double deg = std::numbers::pi / 180;
/// Of what a wheel takes; told at the first, and by a plan at the second.
constexpr double much = 0.8, too_much = 0.95;
/// By which wheels are emptied, and below which they are empty.
constexpr double unloading_per_s = 0.05, empty_n_m_s = 0.01;

[[nodiscard]] Vector3 vector_of(const Three& numbers) noexcept { return {numbers[0], numbers[1], numbers[2]}; }
[[nodiscard]] Three three_of(const Vector3& vector) noexcept { return {vector.x(), vector.y(), vector.z()}; }

class Aocs final : public Subsystem {
  // Structures of aocs.xml: same members, same order.
  struct CurrentState {
    Three position_m;
    Four orientation_wxyz;
    Three rate_rad_s;
    Three velocity_m_s;
  };
  struct GainValues {
    double stiffness_n_m;
    double damping_n_m_s;
  };
  struct Sensors {
    Three position_m;
    Four orientation_wxyz;
    Three rate_rad_s;
    Three velocity_m_s;
  };
  struct Stored {
    Three wheels_n_m_s;
  };
  struct Torques {
    Three wheels_n_m;
    Three thrusters_n_m;
  };
  enum class Trouble : std::uint16_t {
    no_attitude = 0x8001,
    no_wheels = 0x8002,
    actuators_inhibited = 0x8003,
  };

  Result<Step> software_init() override {
    publish("STATE", state_values_);
    publish("WHEELS", stored_values_);
    publish("TORQUE", torque_values_);
    publish("ATT_ERR", error_deg_);
    publish("GAINS", gains_);
    publish("REFERENCE", reference_);
    publish("FREE", free_);
    publish("QUALITY", quality_);
    publish("STAMP", stamp_);
    publish("SETTLED", settled_values_);
    publish("WHEEL_LIMITS", limits_);
    use_device("BASE.SENSORS", sensors_);
    use_device(wheels_device, wheels_);
    use_event(settled_event_);
    use_event(wheels_full_);
    use_event(wheels_too_full_);
    use_event(unloaded_);
    on_function("POINT_TO", [this](Four wxyz) -> Outcome { return point_to(wxyz); });
    on_function("POINT_HERE", [this]() -> Outcome {
      if (!sensors_.fresh() && !sensors_.alive()) return refused(pus::FailureCode::NotPermittedNow);
      return point_to(sensors_.input().orientation_wxyz);
    });
    on_function("DESATURATE", [this](Call call) -> Outcome {
      if (!has_wheels_) return refused(Trouble::no_wheels);
      if (!acting_) return refused(Trouble::actuators_inhibited);
      if (unloading_) return refused(pus::FailureCode::Busy);
      unloading_ = call;
      return running;
    });
    return done;
  }

  Result<> configure(const descriptor::Configuration& configuration) override {
    has_wheels_ = std::ranges::any_of(configuration.devices, [this](const descriptor::DeviceUse& use) {
      return own_descriptor().devices[use.device].name == wheels_device;
    });
    cycle_s_ = seconds(configuration.sampling);
    unloading_.reset();
    settled_.begin();
    full_told_ = too_full_told_ = acting_ = false;
    return ok();
  }

  Result<> pre_operational(const Cycle&) noexcept override {
    measure();
    return ok();
  }
  /// The law runs, and what it would do can be seen.
  Result<> safe_operational(const Cycle& cycle) noexcept override {
    measure();
    if (cycle.first) drop();
    control(false);
    return ok();
  }
  Result<> operational(const Cycle& cycle) noexcept override {
    measure();
    if (cycle.first) settled_.begin();
    if (!cycle.active) drop();
    control(cycle.active);
    acting_ = has_wheels_ && cycle.active;
    free_.store(acting_ ? 0 : 1);
    if (acting_) watch_wheels();
    return ok();
  }
  Result<> error_operational(const Cycle& cycle) noexcept override {
    measure();
    if (cycle.first) drop();
    wheels_.output() = {};
    return ok();
  }

  Outcome point_to(const Four& wxyz) noexcept {
    Quaternion wanted{wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
    if (!(wanted.norm() > 0.5 && wanted.norm() < 1.5)) return refused(Trouble::no_attitude);
    wanted.normalize();
    reference_.store({wanted.w(), wanted.x(), wanted.y(), wanted.z()});
    settled_.begin();
    return ok();
  }

  void drop() noexcept {
    if (unloading_) abort(*unloading_, pus::FailureCode::Aborted);
    unloading_.reset();
  }

  void measure() noexcept {
    const Sensors& in = sensors_.input();
    state_values_.store({in.position_m, in.orientation_wxyz, in.rate_rad_s, in.velocity_m_s});
    if (has_wheels_) stored_values_.store(wheels_.input().wheels_n_m_s);
    // A consumer sees by it whether a sample is of a measurement or of none.
    quality_.store(sensors_.alive() ? 1 : 0);
    stamp_.store(stamp_.load() + 1);
    acting_ = false;
    free_.store(1);
  }

  void control(bool active) noexcept {
    const Sensors& in = sensors_.input();
    const auto wxyz = reference_.load();
    const Quaternion reference{wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
    const Four& is = in.orientation_wxyz;
    const Vector3 error = aocs::attitude_error(reference, Quaternion{is[0], is[1], is[2], is[3]});
    const Vector3 rate = vector_of(in.rate_rad_s);
    error_deg_.store(error.norm() / deg);
    Torques torques{};
    if (has_wheels_) {
      const GainValues gains = gains_.load();
      const double most = limits_.load()[0];
      Vector3 by_wheels = aocs::attitude_torque(error, rate, {gains.stiffness_n_m, gains.damping_n_m_s}, most);
      if (active && unloading_) {
        const Vector3 stored = vector_of(wheels_.input().wheels_n_m_s);
        const Vector3 room = Vector3::Constant(most) - by_wheels.cwiseAbs();
        const Vector3 by_thrusters = aocs::unloading_torque(stored, unloading_per_s, room);
        by_wheels += by_thrusters;
        torques.thrusters_n_m = three_of(-by_thrusters);
        if (stored.cwiseAbs().maxCoeff() < empty_n_m_s) {
          raise(unloaded_);
          finish(*unloading_);
          unloading_.reset();
        }
      }
      torques.wheels_n_m = three_of(by_wheels);
      if (active && settled_.update(error, rate, cycle_s_, {})) raise(settled_event_, error.norm() / deg);
    }
    settled_values_.store(has_wheels_ && active && settled_.now() ? 1 : 0);
    wheels_.output() = torques;
    torque_values_.store(torques.wheels_n_m);
  }

  void watch_wheels() noexcept {
    const double most = limits_.load()[1];
    const double share = vector_of(wheels_.input().wheels_n_m_s).cwiseAbs().maxCoeff() / most;
    if (share > much && !full_told_) raise(wheels_full_, share);
    if (share > too_much && !too_full_told_) raise(wheels_too_full_, share);
    full_told_ = share > much;
    too_full_told_ = share > too_much;
  }

  Parameter<CurrentState> state_values_;
  Parameter<Three> stored_values_, torque_values_;
  Parameter<double> error_deg_;
  Parameter<GainValues> gains_;
  Parameter<Four> reference_;
  Parameter<std::uint8_t> free_, quality_, settled_values_;
  Parameter<std::uint32_t> stamp_;
  Parameter<std::array<double, 2>> limits_;  ///< N m, N m s
  Event<double> settled_event_{"ATTITUDE_SETTLED"};  ///< deg
  Event<double> wheels_full_{"WHEELS_FULL"}, wheels_too_full_{"WHEELS_TOO_FULL"};  ///< share
  Event<> unloaded_{"WHEELS_UNLOADED"};
  DevicePort<Sensors, NoFields> sensors_;
  DevicePort<Stored, Torques> wheels_;

  aocs::Settled settled_;
  std::optional<Call> unloading_;
  double cycle_s_{0.01};
  bool has_wheels_{false};
  bool acting_{false};  ///< what is put out reaches the wheels
  bool full_told_{false};
  bool too_full_told_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_aocs() { return std::make_unique<Aocs>(); }

}  // namespace hirosco
