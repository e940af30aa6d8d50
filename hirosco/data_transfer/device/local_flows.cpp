// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/local_flows.hpp"

#include <algorithm>
#include <array>

namespace hirosco {

/// What one address is: for each side whether it is open, and the newest frame on its way to it.
struct LocalFlows::Pair {
  struct Side {
    bool open{false};
    std::uint64_t openings{0};
    bool fresh{false};
    std::size_t octets{0};
    std::array<std::byte, max_frame_octets> frame{};
  };
  std::array<Side, 2> sides;
};

namespace {

class LocalFlow final : public DataFlow {
 public:
  LocalFlow(std::shared_ptr<LocalFlows::Pair> pair, FlowSide side)
      : pair_{std::move(pair)},
        own_{pair_->sides[side == FlowSide::Subsystem ? 0 : 1]},
        peer_{pair_->sides[side == FlowSide::Subsystem ? 1 : 0]},
        peer_openings_{peer_.openings - (peer_.open ? 1 : 0)} {
    own_.open = true;
    ++own_.openings;
    own_.fresh = false;
  }
  ~LocalFlow() override { own_.open = false; }
  LocalFlow(const LocalFlow&) = delete;
  LocalFlow& operator=(const LocalFlow&) = delete;

 private:
  [[nodiscard]] Result<> do_send(Octets frame) noexcept override {
    if (frame.size() > max_frame_octets)
      return fail(ErrorCode::OutOfRange, "octets of frame", static_cast<std::int64_t>(frame.size()));
    if (!peer_.open) return fail(ErrorCode::Unavailable, "nobody listens");
    copy_octets(frame, peer_.frame);
    peer_.octets = frame.size();
    peer_.fresh = true;
    return ok();
  }

  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override {
    if (!own_.fresh) {
      // A peer that never came is not a peer that has gone.
      if (!peer_.open && peer_.openings != peer_openings_) return fail(ErrorCode::Unavailable, "peer has hung up");
      return Received{};
    }
    own_.fresh = false;
    if (own_.octets > buffer.size())
      return fail(ErrorCode::Malformed, "frame is longer than expected", static_cast<std::int64_t>(own_.octets));
    copy_octets(Octets{own_.frame}.first(own_.octets), buffer);
    return Received{Flow::New, own_.octets};
  }

  /// Time does not pass here: what is not there now does not come while we look.
  [[nodiscard]] bool do_wait(Duration) noexcept override { return own_.fresh; }

  std::shared_ptr<LocalFlows::Pair> pair_;
  LocalFlows::Pair::Side& own_;
  LocalFlows::Pair::Side& peer_;
  std::uint64_t peer_openings_;
};

}  // namespace

Result<std::unique_ptr<DataFlow>> LocalFlows::do_open(const FlowAddress& address, FlowSide side) {
  auto& pair = pairs_[{address.transfer, address.address}];
  if (!pair) pair = std::make_shared<Pair>();
  if (pair->sides[side == FlowSide::Subsystem ? 0 : 1].open)
    return fail(ErrorCode::AlreadyExists, "this side of the flow is open");
  return std::make_unique<LocalFlow>(pair, side);
}

}  // namespace hirosco
