// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/stream_channel.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

namespace hirosco {
namespace {

/// A peer that only talks holds nobody up.
constexpr int frames_per_look = 1024;
constexpr Error peer_gone{ErrorCode::Unavailable, "peer of control channel is gone"};

[[nodiscard]] bool must_wait(int number) noexcept { return number == EAGAIN || number == EINTR || number == ENOBUFS; }
[[nodiscard]] bool is_damage(ErrorCode code) noexcept {
  return code == ErrorCode::Malformed || code == ErrorCode::Mismatch;
}

}  // namespace

StreamChannel::StreamChannel(FileDescriptor socket, StreamWords& words)
    : socket_{std::move(socket)}, words_{words}, out_(out_octets), in_(in_octets) {}

Result<std::pair<FileDescriptor, FileDescriptor>> StreamChannel::make_pair() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) != 0)
    return fail(ErrorCode::SystemFailure, "make stream of a member", errno);
  return std::pair{FileDescriptor{ends[0]}, FileDescriptor{ends[1]}};
}

void StreamChannel::step(TimePoint now) {
  take_in();
  if (send_words(now >= words_due_) && now >= words_due_) words_due_ = now + words_period;
  flush();
}

Result<> StreamChannel::send(const Message& message) {
  if (message.packet.size() > max_packet_octets)
    return fail(ErrorCode::InvalidArgument, "octets of packet", static_cast<std::int64_t>(message.packet.size()));
  if (message.memory) return fail(ErrorCode::InvalidArgument, "memory does not cross a stream");
  // What gates a message is there before it: a mode, a permission, a fence.
  if (!send_words(false)) return fail(ErrorCode::ResourceExhausted, "peer does not read");
  std::array<std::byte, envelope::octets> head;
  OctetWriter writer{head};
  envelope::write(writer, message);
  HIROSCO_TRY(put(StreamFrameKind::Message, head, message.packet));
  flush();
  return ok();
}

Result<Channel::Found> StreamChannel::receive(MessageBuffer& buffer) {
  if (messages_.empty()) take_in();
  if (!messages_.empty()) {
    Stored stored = std::move(messages_.front());
    messages_.pop_front();
    copy_octets(stored.packet, buffer.octets);
    stored.message.packet = Octets{buffer.octets}.first(stored.packet.size());
    return Found{Flow::New, std::move(stored.message)};
  }
  if (!ended_) return Found{};
  return fail(std::exchange(end_told_, true) ? peer_gone : *ended_);
}

Result<> StreamChannel::put(StreamFrameKind kind, Octets head, Octets rest) {
  if (ended_) return fail(peer_gone);
  const std::size_t needed = head.size() + rest.size() + stream_frame_extra_octets;
  if (out_.size() - out_end_ < needed) {
    flush();
    std::copy(out_.begin() + static_cast<std::ptrdiff_t>(out_begin_),
              out_.begin() + static_cast<std::ptrdiff_t>(out_end_), out_.begin());
    out_end_ -= std::exchange(out_begin_, 0);
  }
  if (out_.size() - out_end_ < needed) return fail(ErrorCode::ResourceExhausted, "peer does not read");
  HIROSCO_TRY_LET(const Octets frame, write_stream_frame(MutableOctets{out_}.subspan(out_end_), kind, head, rest));
  out_end_ += frame.size();
  return ok();
}

bool StreamChannel::send_words(bool due) {
  std::array<std::byte, StreamWords::max_octets> room;
  OctetWriter writer{room};
  words_.tell(writer);
  const Octets urgent = writer.written().first(std::min(words_.urgent_octets(), writer.size()));
  if (!due && std::ranges::equal(urgent, urgent_told_)) return true;
  if (!put(words_.told_kind(), writer.written(), {})) return ended_.has_value();
  urgent_told_.assign(urgent.begin(), urgent.end());
  return true;
}

void StreamChannel::flush() {
  while (!ended_ && out_begin_ != out_end_) {
    const ssize_t sent =
        ::send(socket_.get(), out_.data() + out_begin_, out_end_ - out_begin_, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent < 0) {
      const int number = errno;
      if (must_wait(number)) return;
      take_in();  // what it said before it went
      return end({ErrorCode::Unavailable, peer_gone.text, number});
    }
    out_begin_ += static_cast<std::size_t>(sent);
  }
  out_begin_ = out_end_ = 0;
}

void StreamChannel::take_in() {
  for (int left = frames_per_look; left > 0 && !ended_ && messages_.size() < most_messages; --left) {
    const auto frame = read_stream_frame(Octets{in_}.subspan(in_begin_, in_end_ - in_begin_));
    if (!frame) return end(frame.error());
    if (!*frame) {
      if (!read_more()) return;
      continue;
    }
    if (const auto taken = take(**frame); !taken) return end(taken.error());
    in_begin_ += (*frame)->octets;
  }
}

Result<> StreamChannel::take(const StreamFrame& frame) {
  if (frame.kind == words_.heard_kind()) return words_.hear(frame.payload);
  if (frame.kind != StreamFrameKind::Message)
    return fail(ErrorCode::Malformed, "frame of the other side", static_cast<std::int64_t>(frame.kind));
  OctetReader reader{frame.payload};
  HIROSCO_TRY_LET(Message message, envelope::read(reader));
  messages_.push_back({std::move(message), {reader.rest().begin(), reader.rest().end()}});
  return ok();
}

bool StreamChannel::read_more() {
  std::copy(in_.begin() + static_cast<std::ptrdiff_t>(in_begin_), in_.begin() + static_cast<std::ptrdiff_t>(in_end_),
            in_.begin());
  in_end_ -= std::exchange(in_begin_, 0);
  const ssize_t got = ::recv(socket_.get(), in_.data() + in_end_, in_.size() - in_end_, MSG_DONTWAIT);
  if (got < 0 && must_wait(errno)) return false;
  if (got <= 0) {
    const bool in_frame = in_end_ != 0;
    end(in_frame && got == 0 ? Error{ErrorCode::Malformed, "the stream ended within a frame"}
                             : Error{ErrorCode::Unavailable, peer_gone.text, got < 0 ? errno : 0});
    return false;
  }
  in_end_ += static_cast<std::size_t>(got);
  return true;
}

void StreamChannel::end(const Error& why) noexcept {
  if (ended_) return;
  ended_ = why;
  end_told_ = !is_damage(why.code);
  // The peer learns of it, too: who is not understood is not to go on as if it were.
  static_cast<void>(::shutdown(socket_.get(), SHUT_RDWR));
}

}  // namespace hirosco
