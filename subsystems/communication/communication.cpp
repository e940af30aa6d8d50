// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/communication.hpp"

#include <utility>

#include "subsystems/communication/tcp_transport.hpp"

namespace hirosco {
namespace {

using CloseReason = GroundTransport::CloseReason;

constexpr Duration cuts_period = 100ms;
constexpr Duration closing_patience = 500ms;

}  // namespace

Communication::Communication(OpenGroundTransport open)
    : ground_{*this, std::move(open), [this](Octets packet) {
                ends_.went_up(packet);
                last_rx_ = now_;
              }} {}

Result<Step> Communication::software_init() {
  publish("LINK", link_);
  publish("CLIENTS", clients_);
  use_event(ground_link_lost_);
  use_event(ground_link_restored_);
  use_event(client_cut_);
  use_event(telecommands_dropped_);
  return done;
}

Result<> Communication::configure(const descriptor::Configuration&) {
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

Result<Step> Communication::hardware_deinit() {
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

void Communication::service(TimePoint now) {
  if (!ground_.is_open()) return;
  now_ = now;
  if (!closing_since_) ground_.step(now);
  count(now);
}

void Communication::telemetry(Octets packet) {
  if (ground_.is_open() && ends_.goes_down(packet)) ground_.telemetry(packet);
}

/// Gathers the counters in the service loop and hands them to the cycle, which alone writes parameters.
void Communication::count(TimePoint now) {
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
void Communication::tell_cuts(TimePoint now) {
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
Result<> Communication::show() noexcept {
  Link link;
  Clients clients;
  if (shared_link_.snapshot(link)) link_.store(link);
  if (shared_clients_.snapshot(clients)) clients_.store(clients);
  return ok();
}

std::unique_ptr<Subsystem> make_communication() { return make_communication_on(open_tcp_transport); }

std::unique_ptr<Subsystem> make_communication_on(OpenGroundTransport open) {
  return std::make_unique<Communication>(std::move(open));
}

}  // namespace hirosco
