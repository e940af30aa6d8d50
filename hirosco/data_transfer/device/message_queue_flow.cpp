// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/message_queue_flow.hpp"

#include <fcntl.h>
#include <mqueue.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {
namespace {

constexpr long waiting_frames = 8;
constexpr int most_at_once = 16;
constexpr int opening_attempts = 200;

/// In Linux the descriptor of a queue is one of a file.
struct Queue {
  std::string name;
  FileDescriptor file;
};

[[nodiscard]] struct flock whole_queue() noexcept {
  struct flock lock{};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_len = 1;
  return lock;
}

[[nodiscard]] bool lock(int queue) noexcept {
  struct flock wanted = whole_queue();
  return ::fcntl(queue, F_OFD_SETLK, &wanted) == 0;
}

[[nodiscard]] bool is_read_by_another(int queue) noexcept {
  struct flock looked = whole_queue();
  return ::fcntl(queue, F_OFD_GETLK, &looked) == 0 && looked.l_type != F_UNLCK;
}

[[nodiscard]] Result<Queue> open_queue(std::string name) {
  mq_attr room{};
  room.mq_maxmsg = waiting_frames;
  room.mq_msgsize = max_frame_octets;
  FileDescriptor file{::mq_open(name.c_str(), O_RDWR | O_NONBLOCK | O_CREAT | O_CLOEXEC, 0600, &room)};
  if (!file && errno == EACCES)
    return fail(ErrorCode::NotPermitted, "a message queue is refused: a sandbox needs /dev/mqueue mounted", errno);
  if (!file) return fail(ErrorCode::SystemFailure, "open message queue", errno);
  mq_attr found{};
  if (::mq_getattr(file.get(), &found) != 0 || found.mq_msgsize != room.mq_msgsize)
    return fail(ErrorCode::Mismatch, "message queue is not a flow's", found.mq_msgsize);
  return Queue{std::move(name), std::move(file)};
}

/// Whether the name still means the queue.
[[nodiscard]] bool names(const Queue& queue) noexcept {
  const FileDescriptor now{::mq_open(queue.name.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  struct stat one{}, other{};
  return now && ::fstat(now.get(), &one) == 0 && ::fstat(queue.file.get(), &other) == 0 && one.st_ino == other.st_ino &&
         one.st_dev == other.st_dev;
}

class MessageQueueFlow final : public DataFlow {
 public:
  MessageQueueFlow(Queue own, Queue peer) : own_{std::move(own)}, peer_{std::move(peer)} {
    // What was for a predecessor is nobody's.
    for (long frames = 0; frames < waiting_frames && take_one() >= 0; ++frames) {}
  }
  MessageQueueFlow(const MessageQueueFlow&) = delete;
  MessageQueueFlow& operator=(const MessageQueueFlow&) = delete;
  ~MessageQueueFlow() override {
    if (!lock(peer_.file.get())) return;
    if (names(own_)) (void)::mq_unlink(own_.name.c_str());
    if (names(peer_)) (void)::mq_unlink(peer_.name.c_str());
  }

 private:
  [[nodiscard]] ssize_t take_one() noexcept {
    return ::mq_receive(own_.file.get(), reinterpret_cast<char*>(frame_.data()), frame_.size(), nullptr);
  }
  [[nodiscard]] bool put(Octets frame) noexcept {
    return ::mq_send(peer_.file.get(), reinterpret_cast<const char*>(frame.data()), frame.size(), 0) == 0;
  }
  [[nodiscard]] bool peer_is_there() noexcept {
    const bool there = is_read_by_another(peer_.file.get());
    peer_came_ = peer_came_ || there;
    return there;
  }

  [[nodiscard]] Result<> do_send(Octets frame) noexcept override {
    if (frame.size() > max_frame_octets)
      return fail(ErrorCode::OutOfRange, "octets of frame", static_cast<std::int64_t>(frame.size()));
    if (!peer_is_there()) return fail(ErrorCode::Unavailable, "nobody listens");
    if (put(frame)) return ok();
    if (errno != EAGAIN) return fail(ErrorCode::SystemFailure, "send frame", errno);
    std::array<char, max_frame_octets> oldest;
    (void)::mq_receive(peer_.file.get(), oldest.data(), oldest.size(), nullptr);
    return put(frame) ? ok() : fail(ErrorCode::Unavailable, "peer does not read", errno);
  }

  [[nodiscard]] Result<Received> do_receive(MutableOctets buffer) noexcept override {
    ssize_t octets = -1;
    for (int frames = 0; frames < most_at_once; ++frames) {
      const ssize_t next = take_one();
      if (next < 0) break;
      octets = next;
    }
    if (octets < 0) {
      if (peer_is_there() || !peer_came_) return Received{};
      return fail(ErrorCode::Unavailable, "peer has hung up");
    }
    peer_came_ = true;
    const auto filled = static_cast<std::size_t>(octets);
    if (filled > buffer.size()) return fail(ErrorCode::Malformed, "frame is longer than expected", octets);
    copy_octets(Octets{frame_}.first(filled), buffer);
    return Received{Flow::New, filled, 0};
  }

  [[nodiscard]] bool do_wait(Duration timeout) noexcept override { return wait_readable(own_.file.get(), timeout); }

  Queue own_, peer_;
  std::array<std::byte, max_frame_octets> frame_{};
  bool peer_came_{false};
};

}  // namespace

Result<std::unique_ptr<DataFlow>> open_message_queue_flow(const std::string& address, FlowSide side) {
  if (address.empty() || address.size() > 200 || address.find('\0') != std::string::npos)
    return fail(ErrorCode::InvalidArgument, "address of a message queue");
  std::string to_device = "/hirosco." + address;
  std::replace(to_device.begin() + 1, to_device.end(), '/', '.');
  std::string to_subsystem = to_device + ".to_subsystem";
  to_device += ".to_device";
  for (int attempts = 0; attempts < opening_attempts; ++attempts) {
    HIROSCO_TRY_LET(Queue own, open_queue(side == FlowSide::Device ? to_device : to_subsystem));
    HIROSCO_TRY_LET(Queue peer, open_queue(side == FlowSide::Device ? to_subsystem : to_device));
    if (!lock(own.file.get())) return fail(ErrorCode::AlreadyExists, "this side of the flow is open");
    // Who went last may have removed them meanwhile.
    if (names(own) && names(peer)) return std::make_unique<MessageQueueFlow>(std::move(own), std::move(peer));
  }
  return fail(ErrorCode::Unavailable, "message queue is made and removed all the time");
}

}  // namespace hirosco
