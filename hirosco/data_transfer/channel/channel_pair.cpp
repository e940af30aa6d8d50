// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/channel_pair.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <utility>
#include <vector>

namespace hirosco {
namespace {

struct Stored {
  Message message;               ///< without its packet
  std::vector<std::byte> packet;
};

/// One direction. Its places are used again and again, and there are some from the start: who speaks through it takes nothing from
/// the heap but where more wait than ever did.
struct OneWay {
  explicit OneWay(std::size_t limit) : capacity{limit} { grow(); }
  std::mutex mutex;
  const std::size_t capacity;
  bool reader_gone{false};
  bool writer_gone{false};

  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  void push(const Message& message) {
    if (count_ == places_.size()) grow();
    Stored& place = places_[(first_ + count_) % places_.size()];
    place.message = message;
    place.message.packet = {};
    place.packet.assign(message.packet.begin(), message.packet.end());
    ++count_;
  }
  /// Its packet is copied into the buffer.
  [[nodiscard]] Message pop(MessageBuffer& buffer) {
    Stored& place = places_[first_];
    Message message = std::exchange(place.message, {});
    copy_octets(place.packet, buffer.octets);
    message.packet = Octets{buffer.octets}.first(place.packet.size());
    first_ = (first_ + 1) % places_.size();
    --count_;
    return message;
  }
  void clear() noexcept {
    for (; count_ > 0; --count_, first_ = (first_ + 1) % places_.size()) places_[first_].message = {};
  }

 private:
  void grow() {
    constexpr std::size_t least = 16;
    const std::size_t before = places_.size();
    std::ranges::rotate(places_, places_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
    places_.resize(std::min(capacity, std::max(least, 2 * before)));
    for (std::size_t i = before; i < places_.size(); ++i) places_[i].packet.reserve(max_packet_octets);
  }

  std::vector<Stored> places_;
  std::size_t first_{0};
  std::size_t count_{0};
};

class End final : public Channel {
 public:
  End(OneWay& out, OneWay& in) noexcept : out_{out}, in_{in} {}

  [[nodiscard]] Result<> send(const Message& message) override {
    if (message.packet.size() > max_packet_octets)
      return fail(ErrorCode::InvalidArgument, "octets of packet", static_cast<std::int64_t>(message.packet.size()));
    const std::scoped_lock lock{out_.mutex};
    if (out_.reader_gone || out_.writer_gone) return fail(ErrorCode::Unavailable, "peer of control channel is gone");
    if (out_.size() >= out_.capacity) return fail(ErrorCode::ResourceExhausted, "peer does not read");
    out_.push(message);
    return ok();
  }

  [[nodiscard]] Result<Found> receive(MessageBuffer& buffer) override {
    const std::scoped_lock lock{in_.mutex};
    if (in_.reader_gone) return fail(ErrorCode::Unavailable, "control channel is closed");
    if (in_.size() == 0) {
      if (in_.writer_gone) return fail(ErrorCode::Unavailable, "peer of control channel is gone");
      return Found{};
    }
    return Found{Flow::New, in_.pop(buffer)};
  }

  /// Messages.
  [[nodiscard]] Fill outbound() noexcept override {
    const std::scoped_lock lock{out_.mutex};
    return {out_.size(), out_.capacity};
  }

  void close() noexcept {
    {
      const std::scoped_lock lock{out_.mutex};
      out_.writer_gone = true;
    }
    const std::scoped_lock lock{in_.mutex};
    in_.reader_gone = true;
    in_.clear();
  }

 private:
  OneWay& out_;
  OneWay& in_;
};

}  // namespace

struct ChannelPair::State {
  explicit State(std::size_t capacity) : down{capacity}, up{capacity} {}
  OneWay down;  ///< to the subsystem
  OneWay up;  ///< to the supervisor
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
  const auto nothing_in = [](OneWay& queue) {
    const std::scoped_lock lock{queue.mutex};
    return queue.size() == 0;
  };
  return nothing_in(state_->down) && nothing_in(state_->up);
}
void ChannelPair::close_supervisor_end() noexcept { state_->supervisor.close(); }
void ChannelPair::close_subsystem_end() noexcept { state_->subsystem.close(); }

}  // namespace hirosco
