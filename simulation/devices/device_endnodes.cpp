// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/device_endnodes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace hirosco::simulation {
namespace {

constexpr Duration longest_unseen = std::chrono::microseconds{250};  // of a frame by a flow that is not waited for

}  // namespace

Result<> DeviceEndnodes::open() {
  std::vector<FlowAddress> addresses{described_.address};
  addresses.insert(addresses.end(), described_.fall_backs.begin(), described_.fall_backs.end());
  HIROSCO_TRY_LET(auto driving, EndnodeWays::open(flows_, std::move(addresses)));
  std::vector<FurtherExchange> further;
  for (const FurtherEndnode& described : described_.further) {
    HIROSCO_TRY_LET(auto ways, EndnodeWays::open(flows_, described.addresses));
    further.emplace_back(described, std::move(ways));
  }
  driving_ = std::move(driving);
  further_ = std::move(further);
  return ok();
}

void DeviceEndnodes::close() noexcept {
  driving_.reset();
  further_.clear();
}

Result<Received> DeviceEndnodes::receive(MutableOctets buffer) noexcept {
  if (driving_ == nullptr) return fail(ErrorCode::Unavailable, "unplugged");
  Result<Received> received = driving_->receive(buffer);
  peer_gone_ = !received && received.error().code == ErrorCode::Unavailable;
  return received;
}

bool DeviceEndnodes::wait(Duration timeout) noexcept {
  if (driving_ == nullptr || peer_gone_) return false;
  if (driving_->count() == 1 && further_.empty()) return driving_->wait(timeout);
  return driving_->wait(std::min(timeout, longest_unseen)) || timeout > longest_unseen;
}

EndnodeWays* DeviceEndnodes::ways_of(std::string_view endnode) noexcept {
  if (endnode == described_.name) return driving_.get();
  const auto found = std::ranges::find(further_, endnode, &FurtherExchange::name);
  return found != further_.end() ? &found->ways() : nullptr;
}

Result<> DeviceEndnodes::fault(const Words& words) {
  const bool named = words[0] == "endnode";
  EndnodeWays* ways = named ? ways_of(words[1]) : driving_.get();
  return fault_way(ways, words, named ? 2 : 1);
}

void DeviceEndnodes::heal() noexcept {
  if (driving_ != nullptr) driving_->heal();
  for (FurtherExchange& each : further_) each.ways().heal();
}

void DeviceEndnodes::forget() noexcept {
  for (FurtherExchange& each : further_) each.forget();
}

}  // namespace hirosco::simulation
