// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/communication.hpp"

#include <utility>

namespace hirosco {
namespace {

using communication::CloseReason;

class Communication final : public Subsystem, private communication::GroundTraffic {
 public:
  explicit Communication(OpenGroundTransport open) : open_{std::move(open)} {}

 private:
  // Structures of communication.xml: same members, same order.
  struct Link {
    std::uint8_t connected;
    std::uint32_t rx;
    std::uint32_t tx;
    std::uint32_t dropped;
    std::uint32_t last_rx_ms;
  };
  struct Clients {
    std::uint32_t accepted;
    std::uint32_t cut_slow;
    std::uint32_t evicted;
    std::uint32_t bad_header;
    std::uint32_t bad_length;
    std::uint32_t incomplete;
  };
  static constexpr Duration ground_patience = 2s;
  enum Event : std::uint16_t { ground_link_lost = 201, ground_link_restored = 202, client_cut = 203 };

  Result<Step> software_init() override {
    publish("LINK", link_);
    publish("CLIENTS", clients_);
    return done;
  }

  Result<> configure(const descriptor::Configuration&) override {
    HIROSCO_TRY_LET(transport_, open_(*this));
    had_client_ = false;
    return ok();
  }

  Result<> pre_operational(const Cycle&) noexcept override { return show(); }
  Result<> safe_operational(const Cycle&) noexcept override { return show(); }
  Result<> operational(const Cycle&) noexcept override { return show(); }
  Result<> error_operational(const Cycle&) noexcept override { return show(); }

  Result<Step> post_operational() override {
    transport_.reset();
    return done;
  }

  void service(TimePoint now) override {
    if (!transport_) return;
    now_ = now;
    transport_->step(now);
    count(now);
  }

  void telemetry(Octets packet) override {
    if (transport_) transport_->telemetry(packet);
  }

  void telecommand(communication::ClientId client, Octets packet) override {
    last_rx_ = now_;
    if (!submit_ground_telecommand(client, packet)) ++dropped_;
  }

  /// Gathers the counters in the service loop and hands them to the cycle, which alone writes parameters.
  void count(TimePoint now) {
    const communication::LinkCounters& counters = transport_->counters();
    const auto u32 = [](std::uint64_t number) { return static_cast<std::uint32_t>(number); };
    const auto closed = [&](CloseReason reason) { return u32(counters.closed[static_cast<std::size_t>(reason)]); };
    const bool connected = counters.clients > 0;
    if (connected) last_client_ = now;
    if (connected && !had_client_) raise_in_service(ground_link_restored);
    if (connected) had_client_ = true;
    // A tool that asks and goes is no loss of the ground: only a silence is, and only after somebody was there.
    if (had_client_ && now - last_client_ > ground_patience) {
      had_client_ = false;
      raise_in_service(ground_link_lost);
    }
    if (closed(CloseReason::Slow) > cut_) raise_in_service(client_cut);
    cut_ = closed(CloseReason::Slow);
    const auto age = std::chrono::duration_cast<std::chrono::milliseconds>(now - last_rx_).count();
    next_link_ = {static_cast<std::uint8_t>(connected), u32(counters.packets), u32(counters.telemetry_packets),
                  dropped_, last_rx_ == TimePoint{} ? 0U : static_cast<std::uint32_t>(age)};
    next_clients_ = {u32(counters.admitted),       closed(CloseReason::Slow),
                     closed(CloseReason::Evicted), closed(CloseReason::Version) + closed(CloseReason::NotTelecommand),
                     closed(CloseReason::Length),  closed(CloseReason::Incomplete)};
    shared_link_.store(next_link_);
    shared_clients_.store(next_clients_);
  }

  /// The cycle takes over the service loop's newest whole copy.
  Result<> show() noexcept {
    Link link;
    Clients clients;
    if (shared_link_.snapshot(link)) link_.store(link);
    if (shared_clients_.snapshot(clients)) clients_.store(clients);
    return ok();
  }

  OpenGroundTransport open_;
  std::unique_ptr<GroundTransport> transport_;
  Parameter<Link> link_;
  Parameter<Clients> clients_;
  // Single-writer cells of the service loop: the wait-free hand-over to the cycle.
  Parameter<Link> shared_link_;
  Parameter<Clients> shared_clients_;
  Link next_link_{};
  Clients next_clients_{};
  TimePoint now_{};
  TimePoint last_rx_{};
  TimePoint last_client_{};
  std::uint32_t dropped_{0};
  std::uint32_t cut_{0};
  bool had_client_{false};
};

}  // namespace

std::unique_ptr<Subsystem> make_communication(OpenGroundTransport open) {
  return std::make_unique<Communication>(std::move(open));
}

}  // namespace hirosco
