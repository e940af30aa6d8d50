// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/communication.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "hirosco/subsystem/author/ground_link.hpp"
#include "subsystems/communication/delay_line.hpp"
#include "subsystems/communication/tcp_transport.hpp"
#include "subsystems/communication/told_ends.hpp"

namespace hirosco {
namespace {

using CloseReason = GroundTransport::CloseReason;

class Communication final : public Subsystem {
 public:
  explicit Communication(OpenGroundTransport open)
      : ground_{*this, std::move(open), [this](Octets packet) {
                  ends_.went_up(packet);
                  last_rx_ = now_;
                }} {}

 private:
  // Structures of communication.xml: same members, same order.
  struct Link {
    std::uint8_t connected;
    std::uint32_t rx;
    std::uint32_t tx;
    std::uint32_t held_back;
    std::uint32_t last_rx_ms;
  };
  struct Clients {
    std::uint32_t accepted;
    std::uint32_t cut_slow;
    std::uint32_t evicted;
    std::uint32_t bad_header;
    std::uint32_t bad_length;
    std::uint32_t incomplete;
    std::uint32_t left;
    std::uint32_t broken;
    std::uint32_t refused;
    std::uint32_t idle_packets;
    std::uint32_t damaged_packets;
    std::uint32_t dropped;
  };
  /// What the joystick on ground sends up, and what it is sent down.
  struct JoystickSet {
    std::array<double, 2> position_rad;
    std::array<double, 2> velocity_rad_per_s;
    std::uint8_t enable;
  };
  struct RobotSet {
    std::array<double, 2> position_rad;
    std::array<double, 2> torque_n_m;
    std::uint8_t active;
  };
  static constexpr Duration ground_patience = 2s;

  Result<Step> software_init() override {
    publish("LINK", link_);
    publish("CLIENTS", clients_);
    publish("DELAY_MS", delay_ms_);
    publish("LOSS", loss_share_);
    publish("UPLINK", uplink_);
    publish("DOWNLINK", downlink_);
    require_link("JOYSTICK_STATE", joystick_);
    require_link("ROBOT_STATE", robot_);
    use_event(ground_link_lost_);
    use_event(ground_link_restored_);
    use_event(client_cut_);
    use_event(telecommands_dropped_);
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
    relay_lost_ = false;
    if (ground_.is_open()) return ok();  // a ground that reconfigures its own link must not be cut off by that
    ports_ = {};
    for (Quota::Held& port : ports_) {
      HIROSCO_TRY_LET(port, acquire_port());
    }
    HIROSCO_TRY(ground_.open());
    had_client_ = false;
    cuts_told_ = {};
    return ok();
  }

  Result<> pre_operational(const Cycle&) noexcept override { return show(); }
  Result<> safe_operational(const Cycle& cycle) noexcept override {
    relay(cycle);
    return show();
  }
  Result<> operational(const Cycle& cycle) noexcept override {
    relay(cycle);
    return show();
  }
  Result<> error_operational(const Cycle&) noexcept override { return show(); }

  /// What clients have already handed to us is the supervisor's to answer, and listeners wait for that answer: the link
  /// closes when all is taken. What is not in time is counted and told, at least to the log.
  Result<Step> hardware_deinit() override {
    if (!ground_.is_open()) return done;
    if (!closing_since_) closing_since_ = now_;
    const std::size_t left = ground_.finish(now_);
    if (left != 0 && now_ - *closing_since_ < closing_patience) return again;
    if (left != 0) raise_in_service(telecommands_dropped_, static_cast<std::uint32_t>(left));
    dropped_ += static_cast<std::uint32_t>(left);
    closing_since_.reset();
    ground_.close();
    ports_ = {};
    return done;
  }

  void service(TimePoint now) override {
    if (!ground_.is_open()) return;
    now_ = now;
    if (!closing_since_) ground_.step(now);
    count(now);
  }

  [[nodiscard]] ServiceWake service_wake() const override { return closing_since_ ? ServiceWake{} : ground_.wake(); }

  void telemetry(Octets packet) override {
    if (ground_.is_open() && ends_.goes_down(packet)) ground_.telemetry(packet);
  }

  /// Gathers the counters in the service loop and hands them to the cycle, which alone writes parameters.
  void count(TimePoint now) {
    const GroundTransport::Counters& counters = ground_.counters();
    const auto u32 = [](std::uint64_t number) { return static_cast<std::uint32_t>(number); };
    const auto closed = [&](CloseReason reason) { return u32(counters.closed[static_cast<std::size_t>(reason)]); };
    const bool connected = counters.clients > 0;
    if (connected) last_client_ = now;
    if (connected && !had_client_) raise_in_service(ground_link_restored_);
    if (connected) had_client_ = true;
    // A tool that asks and goes is no loss of the ground: only a silence is, and only after somebody was there.
    if (had_client_ && now - last_client_ > ground_patience) {
      had_client_ = false;
      raise_in_service(ground_link_lost_);
    }
    tell_cuts(now);
    const auto age = std::chrono::duration_cast<std::chrono::milliseconds>(now - last_rx_).count();
    next_link_ = {static_cast<std::uint8_t>(connected), u32(counters.packets), u32(counters.telemetry_packets),
                  u32(counters.held_back), last_rx_ == TimePoint{} ? 0U : static_cast<std::uint32_t>(age)};
    next_clients_ = {.accepted = u32(counters.admitted),
                     .cut_slow = closed(CloseReason::Slow),
                     .evicted = closed(CloseReason::Evicted),
                     .bad_header = closed(CloseReason::Version) + closed(CloseReason::NotTelecommand),
                     .bad_length = closed(CloseReason::Length),
                     .incomplete = closed(CloseReason::Incomplete),
                     .left = closed(CloseReason::PeerClosed),
                     .broken = closed(CloseReason::SocketError),
                     .refused = u32(counters.refused),
                     .idle_packets = u32(counters.idle_packets),
                     .damaged_packets = u32(counters.packets - counters.valid_packets),
                     .dropped = dropped_};
    shared_link_.store(next_link_);
    shared_clients_.store(next_clients_);
  }

  /// Every connection that the spacecraft ends is told with its reason: at once where it is one, and in a flood as how
  /// many there were since.
  void tell_cuts(TimePoint now) {
    constexpr std::array told{CloseReason::Version,    CloseReason::NotTelecommand, CloseReason::Length,
                              CloseReason::Incomplete, CloseReason::Slow,           CloseReason::Evicted};
    if (now < next_cut_told_) return;
    for (const CloseReason reason : told) {
      const auto place = static_cast<std::size_t>(reason);
      const std::uint64_t closed = ground_.counters().closed[place];
      if (closed == cuts_told_[place]) continue;
      raise_in_service(client_cut_, static_cast<std::uint8_t>(reason),
                       static_cast<std::uint32_t>(closed - cuts_told_[place]));
      cuts_told_[place] = closed;
      next_cut_told_ = now + cuts_period;
    }
  }

  /// The cycle takes over the service loop's newest whole copy.
  Result<> show() noexcept {
    Link link;
    Clients clients;
    if (shared_link_.snapshot(link)) link_.store(link);
    if (shared_clients_.snapshot(clients)) clients_.store(clients);
    return ok();
  }

  /// Carries the telepresence sets between the joystick on ground and the robot, late and with losses as asked for.
  /// What has not arrived for a while is no operator any more: ENABLE and ACTIVE go to 0, the robot holds its setpoint
  /// and the hand feels nothing.
  void relay(const Cycle& cycle) noexcept {
    if (!remote_) return;
    const double cycle_ms = seconds(cycle.period) * 1e3;
    const auto there_and_back = static_cast<std::size_t>(std::lround(static_cast<double>(delay_ms_.load()) / cycle_ms));
    const std::size_t up_cycles = std::min(there_and_back / 2, up_.longest_cycles);
    const std::size_t down_cycles = std::min(there_and_back - there_and_back / 2, down_.longest_cycles);
    const double share = static_cast<double>(loss_share_.load());
    JoystickSet up = up_.pass(joystick_.value(), joystick_.valid() && !loss_.strikes(share), up_cycles);
    RobotSet down = down_.pass(robot_.value(), robot_.valid() && !loss_.strikes(share), down_cycles);
    if (up_.age_cycles() * cycle.period > relay_patience) up.enable = 0;
    if (down_.age_cycles() * cycle.period > relay_patience) down.active = 0;
    uplink_.store(up);
    downlink_.store(down);
    const bool lost = up_.age_cycles() != up_.never && up_.age_cycles() * cycle.period > ground_patience;
    if (lost != relay_lost_) raise(lost ? ground_link_lost_ : ground_link_restored_);
    relay_lost_ = lost;
  }

  static constexpr Duration relay_patience = 100ms;
  static constexpr Duration cuts_period = 100ms;
  static constexpr Duration closing_patience = 500ms;

  std::array<Quota::Held, 2> ports_;  ///< that it listens at; given back after it
  GroundLink ground_;
  Event<> ground_link_lost_{"GROUND_LINK_LOST"};
  Event<> ground_link_restored_{"GROUND_LINK_RESTORED"};
  Event<std::uint8_t, std::uint32_t> client_cut_{"CLIENT_CUT"};  ///< reason, clients
  Event<std::uint32_t> telecommands_dropped_{"TELECOMMANDS_DROPPED"};
  Parameter<Link> link_;
  Parameter<Clients> clients_;
  Parameter<float> delay_ms_;  ///< there and back
  Parameter<float> loss_share_;
  Parameter<JoystickSet> uplink_;
  Parameter<RobotSet> downlink_;
  LinkInput<JoystickSet> joystick_;
  LinkInput<RobotSet> robot_;
  communication::DelayLine<JoystickSet> up_;
  communication::DelayLine<RobotSet> down_;
  communication::Loss loss_;
  communication::ToldEnds ends_;
  bool remote_{false};
  bool relay_lost_{false};
  // Single-writer cells of the service loop: the wait-free hand-over to the cycle.
  Parameter<Link> shared_link_;
  Parameter<Clients> shared_clients_;
  Link next_link_{};
  Clients next_clients_{};
  TimePoint now_{};
  std::optional<TimePoint> closing_since_;
  std::uint32_t dropped_{0};  ///< telecommands that nobody took before the link was closed
  TimePoint last_rx_{};
  TimePoint last_client_{};
  std::array<std::uint64_t, GroundTransport::close_reasons> cuts_told_{};
  TimePoint next_cut_told_{};
  bool had_client_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_communication() { return make_communication_on(open_tcp_transport); }

std::unique_ptr<Subsystem> make_communication_on(OpenGroundTransport open) {
  return std::make_unique<Communication>(std::move(open));
}

}  // namespace hirosco
