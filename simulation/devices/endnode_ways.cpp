// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/endnode_ways.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace hirosco::simulation {

Result<std::unique_ptr<EndnodeWays>> EndnodeWays::open(FlowFactory& flows, std::vector<FlowAddress> addresses) {
  std::vector<Way> ways;
  for (FlowAddress& address : addresses) {
    HIROSCO_TRY_LET(auto flow, flows.open(address, FlowSide::Device));
    ways.push_back({std::move(address), std::move(flow)});
  }
  return std::unique_ptr<EndnodeWays>{new EndnodeWays{flows, std::move(ways)}};
}

Result<> EndnodeWays::fault(std::size_t way, std::string_view what, std::uint32_t frames) {
  if (way >= ways_.size()) return fail(ErrorCode::OutOfRange, "no such fall-back", static_cast<std::int64_t>(way));
  Way& chosen = ways_[way];
  if (what == "unplug") chosen.flow.reset();
  else if (what == "plug") {
    if (chosen.flow != nullptr) return ok();
    HIROSCO_TRY_LET(chosen.flow, flows_.open(chosen.address, FlowSide::Device));
  } else if (what == "silent") chosen.silent = true;
  else if (what == "deaf") chosen.deaf = true;
  else if (what == "corrupt") chosen.corrupt_frames = frames;
  else if (what == "heal") {
    chosen.silent = chosen.deaf = false;
    chosen.corrupt_frames = 0;
  } else return fail(ErrorCode::InvalidArgument, "not a fault of an endnode");
  return ok();
}

void EndnodeWays::heal() noexcept {
  for (Way& way : ways_) {
    way.silent = way.deaf = false;
    way.corrupt_frames = 0;
  }
}

Result<> EndnodeWays::do_send(Octets frame) noexcept { return send_by(asked_by_, frame); }

Result<> EndnodeWays::send_by(std::size_t at, Octets frame) noexcept {
  Way& way = ways_[at];
  if (way.flow == nullptr) return fail(ErrorCode::Unavailable, "unplugged");
  if (way.silent) return ok();
  if (way.corrupt_frames == 0 || frame.empty()) return way.flow->send(frame);
  --way.corrupt_frames;
  std::array<std::byte, max_frame_octets> garbled;
  const std::size_t octets = std::min(frame.size(), garbled.size());
  std::copy_n(frame.begin(), octets, garbled.begin());
  garbled[octets / 2] ^= std::byte{0x40};
  return way.flow->send(Octets{garbled}.first(octets));
}

Result<Received> EndnodeWays::do_receive(MutableOctets buffer) noexcept {
  // The one in use is looked at first: a late word by one that was left does not win. What is wrong with it is told.
  Result<Received> answer = fail(ErrorCode::Unavailable, "unplugged");
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    const std::size_t at = (asked_by_ + i) % ways_.size();
    if (ways_[at].flow == nullptr) continue;
    const Result<Received> received = receive_by(at, buffer);
    const bool news = received && received->flow == Flow::New;
    if (news) asked_by_ = at;
    if (news || i == 0) answer = received;
    if (news) break;
  }
  return answer;
}

Result<Received> EndnodeWays::receive_by(std::size_t at, MutableOctets buffer) noexcept {
  Way& way = ways_[at];
  if (way.flow == nullptr) return fail(ErrorCode::Unavailable, "unplugged");
  const Result<Received> received = way.flow->receive(buffer);
  return way.deaf ? Result<Received>{Received{}} : received;
}

bool EndnodeWays::do_wait(Duration timeout) noexcept {
  const Way& way = ways_[asked_by_];
  return way.flow != nullptr && way.flow->wait(timeout);
}

Result<> fault_way(EndnodeWays* ways, const Words& words, std::size_t at) {
  if (ways == nullptr) return fail(ErrorCode::NotFound, "no such endnode, or it is unplugged");
  const bool counted = words[at + 1] == "corrupt";
  HIROSCO_TRY(words.expect(at + (counted ? 3 : 2)));
  HIROSCO_TRY_LET(const double way, words.number(at, 0, static_cast<double>(ways->count()) - 1));
  double frames = 0;
  if (counted) {
    HIROSCO_TRY_LET(frames, words.number(at + 2, 0, 1e9));
  }
  return ways->fault(static_cast<std::size_t>(way), words[at + 1], static_cast<std::uint32_t>(frames));
}

}  // namespace hirosco::simulation
