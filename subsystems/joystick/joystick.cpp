// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/joystick/joystick.hpp"

#include <array>
#include <optional>

#include "subsystems/joystick/control_law.hpp"

namespace hirosco {
namespace {

using joystick::Axes;

class Joystick final : public Subsystem {
 public:
  explicit Joystick(joystick::Law law) noexcept : answer_{law}, self_check_{law} {}

 private:
  // Structures of joystick.xml: same members, same order.
  struct CurrentValues {
    std::int32_t state;
    Axes position_rad;
    Axes velocity_rad_per_s;
    Axes torque_n_m;
  };
  struct Peer {
    Axes position_rad;
    Axes torque_n_m;
    std::uint32_t age_cycles;
  };
  struct RobotState {
    Axes position_rad;
    Axes torque_n_m;
    std::uint8_t active;
  };
  struct HandleInput {
    Axes position_rad;
    Axes velocity_rad_per_s;
    std::uint8_t hand;   ///< whose hand is on it
    std::uint8_t hands;  ///< bit of each hand that there is
  };
  struct HandleOutput {
    Axes torque_n_m;
    std::uint8_t hand;
    Axes intent_rad;  ///< of a commanded hand
  };
  /// Hands: 0 simulated, 1 commanded, 2 a person's.
  static constexpr std::uint8_t commanded_hand = 1;

  /// An author's failure code of joystick.xml: what is asked for could have no effect.
  static constexpr auto actuators_inhibited = static_cast<pus::FailureCode>(0x8001);

  Result<Step> software_init() override {
    publish("CUR_VALUES", current_);
    publish("DES_TORQUE", desired_torque_);
    publish("FORCE_SCALE", force_scale_);
    publish("PASSIVITY", passivity_);
    publish("PO_ENERGY", observed_energy_);
    publish("PC_DISSIPATED", dissipated_);
    publish("PEER", peer_);
    publish("ENABLE", enable_);
    publish("HAND", hand_);
    require_link("ROBOT_STATE", robot_);
    require_link("REMOTE_ROBOT", remote_robot_);
    use_device("JOYSTICK", handle_);
    use_event(force_clipped_);
    use_event(passivity_active_);
    on_function("DISPLAY_TORQUE", [this](double t1, double t2) { return show({t1, t2}); });
    on_function("CENTRE", [this]() { return show({0.0, 0.0}); });
    on_function("SET_HAND", [this](std::uint8_t hand) -> Outcome { return lay_on(hand); });
    on_function("HAND", [this](double angle_1, double angle_2) -> Outcome {
      if (!acting_) return refused(actuators_inhibited);
      if (handle_.output().hand != commanded_hand) return refused(pus::FailureCode::WrongStatus);
      handle_.output().intent_rad = {angle_1, angle_2};
      return ok();
    });
    on_function("SET_FORCE_SCALE", [this](double scale) -> Outcome {
      force_scale_.store(scale);
      return ok();
    });
    on_function("PASSIVITY", [this](double on) -> Outcome {
      if (!coupled_) return refused(pus::FailureCode::NotPermittedNow);
      passivity_.store(on != 0.0 ? 1 : 0);
      return ok();
    });
    return done;
  }

  Result<> configure(const descriptor::Configuration& configuration) override {
    coupled_ = !configuration.requires_.empty();
    const bool remote = coupled_ && configuration.requires_.front().name == "REMOTE_ROBOT";
    peer_link_ = remote ? &remote_robot_ : &robot_;
    position_force_.emplace(seconds(configuration.sampling));
    passive_position_force_.emplace(seconds(configuration.sampling));
    law_ = &*position_force_;
    commanded_ = {};
    clipped_ = false;
    passive_ = false;
    return ok();
  }

  Result<> pre_operational(const Cycle& cycle) noexcept override {
    measure(cycle, {});
    return ok();
  }
  Result<> safe_operational(const Cycle& cycle) noexcept override {
    if (cycle.first) restart();
    measure(cycle, torque());
    return ok();
  }
  Result<Step> self_test(const Cycle& cycle) noexcept override {
    const HandleInput& in = handle_.input();
    return self_check_.step({.alive = handle_.alive(),
                             .position_rad = in.position_rad,
                             .velocity_rad_s = in.velocity_rad_per_s,
                             .hand = in.hand,
                             .hands = in.hands,
                             .shown_n_m = handle_.output().torque_n_m,
                             .peer_active = coupled_ && peer_acts(),
                             .force_scale = force_scale_.load(),
                             .period_s = seconds(cycle.period)},
                            cycle.first);
  }
  Result<> operational(const Cycle& cycle) noexcept override {
    if (cycle.first) restart();
    measure(cycle, torque());
    acting_ = cycle.active;
    enable_.store(cycle.active ? 1 : 0);
    return ok();
  }
  Result<> error_operational(const Cycle& cycle) noexcept override {
    measure(cycle, {});
    return ok();
  }

  void restart() noexcept {
    law_->reset();
    commanded_ = {};
    handle_.output().hand = handle_.input().hand;
    handle_.output().intent_rad = handle_.input().position_rad;
  }

  Outcome lay_on(std::uint8_t hand) noexcept {
    if (!acting_) return refused(actuators_inhibited);
    const HandleInput& in = handle_.input();
    if ((in.hands >> hand & 1) == 0) return refused(pus::FailureCode::NotPermittedNow);  // this device has no such hand
    if (hand == commanded_hand && handle_.output().hand != hand) handle_.output().intent_rad = in.position_rad;
    handle_.output().hand = hand;
    return ok();
  }

  [[nodiscard]] bool peer_acts() const noexcept { return peer_link_->valid() && peer_link_->value().active != 0; }

  [[nodiscard]] Axes torque() noexcept {
    if (!coupled_) return commanded_;
    choose_law();
    const Axes shown = answer_(*law_,
                               {.velocity_rad_s = handle_.input().velocity_rad_per_s,
                                .peer_torque_n_m = peer_link_->value().torque_n_m,
                                .peer_active = peer_acts()},
                               force_scale_.load());
    observed_energy_.store(law_->observed_energy_j());
    dissipated_.store(law_->dissipated_j());
    if (law_->clipped() && !clipped_) raise(force_clipped_, 1, joystick::DisplayLaw::torque_max_n_m);
    if (law_->controller_acted() && !passive_) raise(passivity_active_, law_->dissipated_j());
    clipped_ = law_->clipped();
    passive_ = passive_ || law_->controller_acted();
    return shown;
  }

  /// The law that PASSIVITY asks for; a new one goes on from the torque that the hand feels.
  void choose_law() noexcept {
    joystick::DisplayLaw* wanted = &*position_force_;
    if (passivity_.load() != 0) wanted = &*passive_position_force_;
    if (wanted == law_) return;
    wanted->take_over(*law_);
    law_ = wanted;
    passive_ = false;
  }

  void measure(const Cycle& cycle, const Axes& torque_n_m) noexcept {
    const HandleInput& in = handle_.input();
    handle_.output().torque_n_m = torque_n_m;
    desired_torque_.store(torque_n_m);
    current_.store({static_cast<std::int32_t>(cycle.state), in.position_rad, in.velocity_rad_per_s,
                    cycle.active ? torque_n_m : Axes{}});
    peer_.store({peer_link_->value().position_rad, peer_link_->value().torque_n_m, peer_link_->age_cycles()});
    acting_ = false;
    enable_.store(0);
    hand_.store(in.hand);
  }

  Outcome show(const Axes& torque_n_m) noexcept {
    if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
    if (!acting_) return refused(actuators_inhibited);
    commanded_ = torque_n_m;
    return ok();
  }

  Event<std::uint8_t, double> force_clipped_{"FORCE_CLIPPED"};  // axis, N m
  Event<double> passivity_active_{"PASSIVITY_ACTIVE"};  // J
  Parameter<CurrentValues> current_;
  Parameter<Axes> desired_torque_;
  Parameter<double> force_scale_;
  Parameter<std::uint8_t> passivity_;
  Parameter<Axes> observed_energy_;
  Parameter<double> dissipated_;
  Parameter<Peer> peer_;
  Parameter<std::uint8_t> enable_;
  Parameter<std::uint8_t> hand_;
  LinkInput<RobotState> robot_;
  LinkInput<RobotState> remote_robot_;
  const LinkInput<RobotState>* peer_link_{&robot_};  ///< the one of the two that the configuration requires
  DevicePort<HandleInput, HandleOutput> handle_;

  std::optional<joystick::PositionForce> position_force_;
  std::optional<joystick::PassivePositionForce> passive_position_force_;
  joystick::DisplayLaw* law_{nullptr};  ///< one of the two
  joystick::Law answer_;
  joystick::SelfCheck self_check_;
  Axes commanded_{};
  bool coupled_{false};
  bool acting_{false};  ///< what is put out reaches the handle
  bool clipped_{false};
  bool passive_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_joystick() { return make_joystick_with(joystick::display_law); }
std::unique_ptr<Subsystem> make_joystick_with(joystick::Law law) { return std::make_unique<Joystick>(law); }

}  // namespace hirosco
