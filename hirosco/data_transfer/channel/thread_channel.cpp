// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/thread_channel.hpp"

#include <algorithm>
#include <vector>

#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {

/// One direction. The packets stand one behind the other in a ring of octets, in the order of the messages.
struct ThreadChannel::Queue {
  Queue(std::uint32_t kb, WakeEvent told, WakeEvent taken)
      : messages(kb), octets(std::size_t{kb} << 10), something{std::move(told)}, room{std::move(taken)} {}

  [[nodiscard]] bool takes(const Message& message) const noexcept {
    return count < messages.size() && octets.size() - used >= message.packet.size();
  }
  void put(const Message& message) {
    Message& slot = messages.at((first + count) % messages.size());
    slot = message;
    const std::size_t begin = (first_octet + used) % octets.size();
    const std::size_t straight = std::min(message.packet.size(), octets.size() - begin);
    copy_octets(message.packet.first(straight), MutableOctets{octets}.subspan(begin));
    copy_octets(message.packet.subspan(straight), octets);
    slot.packet = Octets{octets}.first(message.packet.size());  // its length; where it begins follows from the order
    used += message.packet.size();
    ++count;
  }
  [[nodiscard]] Message take(MessageBuffer& buffer) {
    Message& slot = messages.at(first);
    const std::size_t size = slot.packet.size();
    const std::size_t straight = std::min(size, octets.size() - first_octet);
    const Octets all{octets};
    copy_octets(all.subspan(first_octet, straight), buffer.octets);
    copy_octets(all.first(size - straight), MutableOctets{buffer.octets}.subspan(straight));
    Message message = std::exchange(slot, {});
    message.packet = Octets{buffer.octets}.first(size);
    first = (first + 1) % messages.size();
    first_octet = (first_octet + size) % octets.size();
    used -= size;
    --count;
    return message;
  }

  Mutex mutex;
  std::vector<Message> messages;
  std::vector<std::byte> octets;
  std::size_t first{0}, count{0}, first_octet{0}, used{0};
  bool refused{false};  ///< the writer found no room since the reader took something last
  bool reader_gone{false};
  bool writer_gone{false};
  WakeEvent something;  ///< for the reader
  WakeEvent room;       ///< for the writer
};

Result<std::pair<std::unique_ptr<ThreadChannel>, std::unique_ptr<ThreadChannel>>> ThreadChannel::make_pair(
    std::uint32_t kb) {
  const auto queue = [kb]() -> Result<std::shared_ptr<Queue>> {
    HIROSCO_TRY_LET(auto something, WakeEvent::create());
    HIROSCO_TRY_LET(auto room, WakeEvent::create());
    return std::make_shared<Queue>(kb, std::move(something), std::move(room));
  };
  HIROSCO_TRY_LET(auto down, queue());
  HIROSCO_TRY_LET(auto up, queue());
  return std::pair{std::unique_ptr<ThreadChannel>{new ThreadChannel{down, up}},
                   std::unique_ptr<ThreadChannel>{new ThreadChannel{up, down}}};
}

ThreadChannel::~ThreadChannel() {
  {
    const LockGuard lock{out_->mutex};
    out_->writer_gone = true;
    out_->something.notify();
  }
  const LockGuard lock{in_->mutex};
  in_->reader_gone = true;
  in_->room.notify();  // whoever waits for it shall find out
}

Result<> ThreadChannel::send(const Message& message) {
  if (message.packet.size() > max_packet_octets)
    return fail(ErrorCode::InvalidArgument, "octets of packet", static_cast<std::int64_t>(message.packet.size()));
  Queue& queue = *out_;
  const LockGuard lock{queue.mutex};
  if (queue.reader_gone) return fail(ErrorCode::Unavailable, "peer of control channel is gone");
  if (!queue.takes(message)) {
    queue.refused = true;
    queue.room.clear();
    return fail(ErrorCode::ResourceExhausted, "peer does not read");
  }
  queue.put(message);
  if (queue.count == 1) queue.something.notify();
  return ok();
}

Channel::Fill ThreadChannel::outbound() noexcept {
  Queue& queue = *out_;
  const LockGuard lock{queue.mutex};
  const bool by_octets = queue.used * queue.messages.size() > queue.count * queue.octets.size();
  return by_octets ? Fill{queue.used, queue.octets.size()} : Fill{queue.count, queue.messages.size()};
}

Result<Channel::Found> ThreadChannel::receive(MessageBuffer& buffer) {
  Queue& queue = *in_;
  const LockGuard lock{queue.mutex};
  if (queue.count == 0) {
    queue.something.clear();  // also of one who is gone, which was told by then: it would end every wait
    if (queue.writer_gone) return fail(ErrorCode::Unavailable, "peer of control channel is gone");
    return Found{};
  }
  Message message = queue.take(buffer);
  if (std::exchange(queue.refused, false)) queue.room.notify();
  return Found{Flow::New, std::move(message)};
}

int ThreadChannel::wait_descriptor() const noexcept { return in_->something.descriptor(); }
int ThreadChannel::room_descriptor() const noexcept { return out_->room.descriptor(); }

}  // namespace hirosco
