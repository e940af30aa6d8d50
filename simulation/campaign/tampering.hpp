// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_frame.hpp"

/// What stands between two parts and changes what they say to each other.
namespace hirosco::campaign {

/// The supervisor's end of a member's channel.
class TamperedChannel final : public Channel {
 public:
  struct Hooks {
    std::function<bool(const Message&)> sends{};                 ///< false: swallowed, as if it had been sent
    std::function<bool(Message&, MessageBuffer&)> receives{};    ///< false: never came; may change it
    std::function<bool()> holds_back{};                          ///< true: nothing comes now
  };
  TamperedChannel(std::unique_ptr<Channel> channel, Hooks hooks)
      : channel_{std::move(channel)}, hooks_{std::move(hooks)} {}

  Result<> send(const Message& message) override {
    if (hooks_.sends && !hooks_.sends(message)) return ok();
    return channel_->send(message);
  }
  Result<Found> receive(MessageBuffer& buffer) override {
    while (true) {
      if (hooks_.holds_back && hooks_.holds_back()) return Found{};
      auto found = channel_->receive(buffer);
      if (!found || found->flow == Flow::None || !hooks_.receives || hooks_.receives(found->message, buffer))
        return found;
    }
  }

 private:
  std::unique_ptr<Channel> channel_;
  Hooks hooks_;
};

/// The device's side of its flow: changes each command before the device reads it.
class TamperedFlows final : public FlowFactory {
 public:
  using Change = std::function<void(DeviceCommand&)>;
  TamperedFlows(FlowFactory& flows, Change change) : flows_{flows}, change_{std::move(change)} {}

 private:
  class Tampered final : public DataFlow {
   public:
    Tampered(std::unique_ptr<DataFlow> flow, const Change& change) : flow_{std::move(flow)}, change_{change} {}

   private:
    Result<> do_send(Octets frame) noexcept override { return flow_->send(frame); }
    Result<Received> do_receive(MutableOctets buffer) noexcept override {
      auto received = flow_->receive(buffer);
      if (!received || received->flow != Flow::New) return received;
      auto command = read_command(Octets{buffer}.first(received->octets));
      if (!command) return received;
      std::array<std::byte, max_device_frame_octets> octets;
      change_(*command);
      if (const auto written = write_command(octets, *command)) {
        std::ranges::copy(*written, buffer.begin());
        received->octets = written->size();
      }
      return received;
    }
    bool do_wait(Duration timeout) noexcept override { return flow_->wait(timeout); }

    std::unique_ptr<DataFlow> flow_;
    const Change& change_;
  };

  Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress& address, FlowSide side) override {
    HIROSCO_TRY_LET(auto flow, flows_.open(address, side));
    return std::make_unique<Tampered>(std::move(flow), change_);
  }

  FlowFactory& flows_;
  Change change_;
};

}  // namespace hirosco::campaign
