// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/control/channel_pair.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <mutex>
#include <vector>

namespace hirosco {
namespace {

struct Stored {
  Message message;               ///< without its packet
  std::vector<std::byte> packet;
};

/// One direction.
struct Queue {
  explicit Queue(std::size_t limit) : capacity{limit} {}
  std::mutex mutex;
  const std::size_t capacity;
  std::deque<Stored> messages;
  bool reader_gone{false};
  bool writer_gone{false};
};

class End final : public Channel {
 public:
  End(Queue& out, Queue& in) noexcept : out_{out}, in_{in} {}

  [[nodiscard]] Result<> send(const Message& message) override {
    if (message.packet.size() > max_packet_octets)
      return fail(ErrorCode::InvalidArgument, "octets of packet", static_cast<std::int64_t>(message.packet.size()));
    const std::scoped_lock lock{out_.mutex};
    if (out_.reader_gone || out_.writer_gone) return fail(ErrorCode::Unavailable, "peer of control channel is gone");
    if (out_.messages.size() >= out_.capacity) return fail(ErrorCode::ResourceExhausted, "peer does not read");
    Stored stored{message, {message.packet.begin(), message.packet.end()}};
    stored.message.packet = {};
    out_.messages.push_back(std::move(stored));
    return ok();
  }

  [[nodiscard]] Result<Found> receive(MessageBuffer& buffer) override {
    const std::scoped_lock lock{in_.mutex};
    if (in_.reader_gone) return fail(ErrorCode::Unavailable, "control channel is closed");
    if (in_.messages.empty()) {
      if (in_.writer_gone) return fail(ErrorCode::Unavailable, "peer of control channel is gone");
      return Found{};
    }
    Stored stored = std::move(in_.messages.front());
    in_.messages.pop_front();
    std::ranges::copy(stored.packet, buffer.octets.begin());
    stored.message.packet = Octets{buffer.octets}.first(stored.packet.size());
    return Found{Flow::New, std::move(stored.message)};
  }

  void close() noexcept {
    {
      const std::scoped_lock lock{out_.mutex};
      out_.writer_gone = true;
    }
    const std::scoped_lock lock{in_.mutex};
    in_.reader_gone = true;
    in_.messages.clear();
  }

 private:
  Queue& out_;
  Queue& in_;
};

}  // namespace

struct ChannelPair::State {
  explicit State(std::size_t capacity) : down{capacity}, up{capacity} {}
  Queue down;  ///< to the subsystem
  Queue up;    ///< to the supervisor
  End supervisor{down, up};
  End subsystem{up, down};
};

ChannelPair::ChannelPair(std::size_t capacity) : state_{std::make_unique<State>(capacity)} {}
ChannelPair::ChannelPair(ChannelPair&&) noexcept = default;
ChannelPair& ChannelPair::operator=(ChannelPair&&) noexcept = default;
ChannelPair::~ChannelPair() = default;

Channel& ChannelPair::supervisor_end() noexcept { return state_->supervisor; }
Channel& ChannelPair::subsystem_end() noexcept { return state_->subsystem; }
bool ChannelPair::empty() const noexcept {
  const auto nothing_in = [](Queue& queue) {
    const std::scoped_lock lock{queue.mutex};
    return queue.messages.empty();
  };
  return nothing_in(state_->down) && nothing_in(state_->up);
}
void ChannelPair::close_supervisor_end() noexcept { state_->supervisor.close(); }
void ChannelPair::close_subsystem_end() noexcept { state_->subsystem.close(); }

}  // namespace hirosco
