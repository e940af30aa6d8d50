// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/telepresence_relay/telepresence_relay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "subsystems/communication/tcp_transport.hpp"
#include "subsystems/communication/telepresence_relay/delay_line.hpp"

namespace hirosco {
namespace {

class TelepresenceRelay final : public Communication {
 public:
  using Communication::Communication;

 private:
  /// What the operator's hand controller sends up, and what it is sent down.
  struct OperatorSet {
    std::array<double, 2> position_rad;
    std::array<double, 2> velocity_rad_per_s;
    std::uint8_t enable;
  };
  struct RobotSet {
    std::array<double, 2> position_rad;
    std::array<double, 2> torque_n_m;
    std::uint8_t active;
  };

  Result<Step> software_init() override {
    HIROSCO_TRY(Communication::software_init());
    publish("DELAY_MS", delay_ms_);
    publish("LOSS", loss_share_);
    publish("UPLINK", uplink_);
    publish("DOWNLINK", downlink_);
    require_link("JOYSTICK_STATE", operator_);
    require_link("ROBOT_STATE", robot_);
    on_function("SET_DELAY", [this](float delay_ms, float loss) -> Outcome {
      if (!remote_) return refused(pus::FailureCode::NotPermittedNow);
      delay_ms_.store(delay_ms);
      loss_share_.store(loss);
      return ok();
    });
    return done;
  }

  Result<> configure(const descriptor::Configuration& configuration) override {
    remote_ = !configuration.requires_.empty();
    up_.reset();
    down_.reset();
    lost_ = false;
    return Communication::configure(configuration);
  }

  Result<> safe_operational(const Cycle& cycle) noexcept override {
    relay(cycle);
    return Communication::safe_operational(cycle);
  }
  Result<> operational(const Cycle& cycle) noexcept override {
    relay(cycle);
    return Communication::operational(cycle);
  }

  /// Carries the telepresence sets between the hand controller on ground and the robot, late and with losses as asked for.
  /// What has not arrived for a while is no operator any more: ENABLE and ACTIVE go to 0, the robot holds its setpoint
  /// and the hand feels nothing.
  void relay(const Cycle& cycle) noexcept {
    if (!remote_) return;
    const double cycle_ms = seconds(cycle.period) * 1e3;
    const auto there_and_back = static_cast<std::size_t>(std::lround(static_cast<double>(delay_ms_.load()) / cycle_ms));
    const std::size_t up_cycles = std::min(there_and_back / 2, up_.longest_cycles);
    const std::size_t down_cycles = std::min(there_and_back - there_and_back / 2, down_.longest_cycles);
    const double share = static_cast<double>(loss_share_.load());
    OperatorSet up = up_.pass(operator_.value(), operator_.valid() && !loss_.strikes(share), up_cycles);
    RobotSet down = down_.pass(robot_.value(), robot_.valid() && !loss_.strikes(share), down_cycles);
    if (up_.age_cycles() * cycle.period > relay_patience) up.enable = 0;
    if (down_.age_cycles() * cycle.period > relay_patience) down.active = 0;
    uplink_.store(up);
    downlink_.store(down);
    const bool gone = up_.age_cycles() != up_.never && up_.age_cycles() * cycle.period > ground_patience;
    if (gone != lost_) raise(gone ? ground_link_lost_ : ground_link_restored_);
    lost_ = gone;
  }

  static constexpr Duration relay_patience = 100ms;

  Parameter<float> delay_ms_;  ///< there and back
  Parameter<float> loss_share_;
  Parameter<OperatorSet> uplink_;
  Parameter<RobotSet> downlink_;
  LinkInput<OperatorSet> operator_;
  LinkInput<RobotSet> robot_;
  telepresence_relay::DelayLine<OperatorSet> up_;
  telepresence_relay::DelayLine<RobotSet> down_;
  telepresence_relay::Loss loss_;
  bool remote_{false};
  bool lost_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_telepresence_relay() { return make_telepresence_relay_on(open_tcp_transport); }

std::unique_ptr<Subsystem> make_telepresence_relay_on(OpenGroundTransport open) {
  return std::make_unique<TelepresenceRelay>(std::move(open));
}

}  // namespace hirosco
