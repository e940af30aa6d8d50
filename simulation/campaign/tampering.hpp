// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/link/link.hpp"

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

/// A queue whose producer's end lets so many samples through and swallows the next one: nobody counts it.
class LossyQueue final : public LinkMechanism {
 public:
  LossyQueue(const LinkMechanism& queue, std::uint64_t every) : queue_{queue}, every_{every} {}
  [[nodiscard]] LinkMethod method() const noexcept override { return queue_.method(); }
  [[nodiscard]] LinkKind kind() const noexcept override { return queue_.kind(); }
  [[nodiscard]] bool wakes() const noexcept override { return queue_.wakes(); }
  [[nodiscard]] Result<MemoryHandle> establish(MemoryProvider& provider, const LinkLayout& layout) const override {
    return queue_.establish(provider, layout);
  }
  [[nodiscard]] Result<std::unique_ptr<LinkWriter>> produce(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override {
    auto writer = queue_.produce(provider, shared, layout);
    if (!writer) return writer;
    return std::make_unique<Writer>(std::move(*writer), every_);
  }
  [[nodiscard]] Result<std::unique_ptr<LinkReader>> consume(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override {
    return queue_.consume(provider, shared, layout);
  }
  [[nodiscard]] Result<std::unique_ptr<LinkView>> look(MemoryProvider& provider,
                                                       const MemoryHandle& shared) const override {
    return queue_.look(provider, shared);
  }

 private:
  class Writer final : public LinkWriter {
   public:
    Writer(std::unique_ptr<LinkWriter> writer, std::uint64_t every) : writer_{std::move(writer)}, every_{every} {}
    void write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept override {
      if (++written_ % every_ != 0) writer_->write(payload, sampled_at, status);
    }
    void set_status(LinkStatus status) noexcept override { writer_->set_status(status); }

   private:
    std::unique_ptr<LinkWriter> writer_;
    std::uint64_t every_;
    std::uint64_t written_{0};
  };

  const LinkMechanism& queue_;
  std::uint64_t every_;
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
