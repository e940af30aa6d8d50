// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/framed_stream.hpp"

#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace hirosco {
namespace {

[[nodiscard]] ssize_t write_some(FramedStream::Carrier carrier, int descriptor, Octets octets) noexcept {
  if (carrier == FramedStream::Carrier::Socket)
    return ::send(descriptor, octets.data(), octets.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  // As the call itself: write() of the C library is what text is put out by, which nobody does in a cycle.
  return ::syscall(SYS_write, descriptor, octets.data(), octets.size());
}

}  // namespace

void FramedStream::restart() noexcept {
  deframer_.restart();
  out_begin_ = out_end_ = 0;
}

Result<> FramedStream::flush(int descriptor) noexcept {
  if (out_begin_ == out_end_) return ok();
  const Octets rest = Octets{out_}.subspan(out_begin_, out_end_ - out_begin_);
  const ssize_t written = write_some(carrier_, descriptor, rest);
  if (written > 0) out_begin_ += static_cast<std::size_t>(written);
  if (written >= 0 || errno == EAGAIN || errno == EINTR || errno == ENOBUFS) return ok();
  return fail(ErrorCode::Unavailable, "peer has hung up", errno);
}

Result<> FramedStream::send(int descriptor, Octets frame) noexcept {
  if (frame.size() > max_frame_octets)
    return fail(ErrorCode::OutOfRange, "octets of frame", static_cast<std::int64_t>(frame.size()));
  HIROSCO_TRY(flush(descriptor));
  if (out_begin_ != out_end_) return fail(ErrorCode::Unavailable, "peer does not read");
  out_begin_ = 0;
  if (framing_ == Framing::Frames) out_end_ = write_streamed(out_, frame).size();
  else {
    copy_octets(frame, out_);
    out_end_ = frame.size();
  }
  HIROSCO_TRY(flush(descriptor));
  if (out_begin_ != 0 || out_end_ == 0) return ok();
  out_end_ = 0;
  return fail(ErrorCode::Unavailable, "peer does not read");
}

/// 0: nothing is there.
Result<std::size_t> FramedStream::read(int descriptor, MutableOctets room) noexcept {
  const ssize_t octets = ::read(descriptor, room.data(), room.size());
  if (octets > 0) return static_cast<std::size_t>(octets);
  if (octets < 0 && (errno == EAGAIN || errno == EINTR)) return std::size_t{0};
  return fail(ErrorCode::Unavailable, "peer has hung up", octets == 0 ? EPIPE : errno);
}

Result<Received> FramedStream::receive_octets(int descriptor, MutableOctets buffer) noexcept {
  HIROSCO_TRY_LET(const std::size_t octets, read(descriptor, buffer));
  return octets == 0 ? Received{} : Received{Flow::New, octets, 0};
}

Result<Received> FramedStream::receive(int descriptor, MutableOctets buffer) noexcept {
  if (framing_ == Framing::Raw) return receive_octets(descriptor, buffer);
  Received newest;
  std::size_t too_long = 0;
  Result<std::size_t> octets = std::size_t{0};
  for (int reads = 0; reads < most_reads; ++reads) {
    const MutableOctets room = deframer_.room();
    octets = read(descriptor, room);
    if (!octets || *octets == 0) break;
    deframer_.received(*octets);
    // Older frames are let go: whoever paused for a while would else control on what was, for ever.
    while (const auto frame = deframer_.next()) {
      too_long = frame->size() > buffer.size() ? frame->size() : 0;
      if (too_long != 0) continue;
      copy_octets(*frame, buffer);
      newest.flow = Flow::New;
      newest.octets = frame->size();
    }
    if (*octets < room.size()) break;
  }
  newest.damaged = deframer_.take_damaged();
  if (too_long != 0)
    return fail(ErrorCode::Malformed, "frame is longer than expected", static_cast<std::int64_t>(too_long));
  // That it has gone is told when there is nothing else to tell.
  if (!octets && newest.flow == Flow::None) return fail(octets.error());
  return newest;
}

}  // namespace hirosco
