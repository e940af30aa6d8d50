// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/simulated_ground.hpp"

#include "hirosco/utilities/allocation_guard.hpp"

#include <algorithm>
#include <utility>

namespace hirosco::simulation {

class SimulatedGround::OnBoardEnd final : public GroundTransport {
 public:
  OnBoardEnd(SimulatedGround& ground, GroundTraffic& traffic) : ground_{ground}, traffic_{traffic} {
    ground_.end_ = this;
    is_there(ground.there_);
  }
  ~OnBoardEnd() override { ground_.end_ = nullptr; }

  void all_stopped() override { before_stop_ = uplink_.size(); }
  void step(TimePoint) override {
    const HeapPermitted as_of_sockets;  // in a flight these queues are the system's
    while (!uplink_.empty()) {
      constexpr GroundTraffic::ClientId only_client = 1;
      using enum GroundTraffic::Said;
      if (traffic_.telecommand(only_client, uplink_.front(), before_stop_ > 0 ? PerhapsBefore : Since) ==
          GroundTraffic::Taken::Later) {
        ++counters_.held_back;
        return;
      }
      ++counters_.packets;
      counters_.valid_packets += pus::TelecommandView::parse(uplink_.front()) ? 1 : 0;
      uplink_.pop_front();
      before_stop_ -= std::min<std::size_t>(before_stop_, 1);
    }
  }
  [[nodiscard]] std::size_t finish(TimePoint now) override {
    finishing_ = true;
    step(now);
    return uplink_.size();
  }
  void telemetry(Octets packet) override {
    ++counters_.telemetry_packets;
    if (ground_.receive_) ground_.receive_(packet);
  }
  [[nodiscard]] const Counters& counters() const override { return counters_; }
  void is_there(bool there) {
    const auto closed = static_cast<std::size_t>(CloseReason::PeerClosed);
    if (there && counters_.clients == 0) ++counters_.admitted;
    if (!there && counters_.clients == 1) ++counters_.closed[closed];
    counters_.clients = there ? 1 : 0;
  }
  /// False: the link is closing.
  [[nodiscard]] bool arrive(Octets packet) {
    if (!finishing_) uplink_.emplace_back(packet.begin(), packet.end());
    return !finishing_;
  }

 private:
  SimulatedGround& ground_;
  GroundTraffic& traffic_;
  std::deque<std::vector<std::byte>> uplink_;
  std::size_t before_stop_{0};  ///< so many of it
  bool finishing_{false};
  Counters counters_;
};

OpenGroundTransport SimulatedGround::transport() {
  return [this](GroundTraffic& traffic) -> Result<std::unique_ptr<GroundTransport>> {
    if (end_ != nullptr) return fail(ErrorCode::AlreadyExists, "the ground link is open");
    return std::make_unique<OnBoardEnd>(*this, traffic);
  };
}

void SimulatedGround::is_there(bool there) {
  there_ = there;
  if (end_ != nullptr) end_->is_there(there);
}

bool SimulatedGround::send(Octets packet) { return there_ && end_ != nullptr && end_->arrive(packet); }

}  // namespace hirosco::simulation
