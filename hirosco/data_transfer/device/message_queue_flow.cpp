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

#include "hirosco/data_transfer/device/side_lock.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {
namespace {

constexpr long waiting_frames = 8;
constexpr int most_at_once = 16;
constexpr int opening_attempts = 200;
constexpr std::size_t octet_of_reader = 0;   ///< in each of the two queues
constexpr std::size_t octet_of_closing = 1;  ///< in that to the device

/// In Linux the descriptor of a queue is one of a file.
struct Queue {
  std::string name;
  FileDescriptor file;
};

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
  MessageQueueFlow(Queue own, Queue peer, FlowSide side) : own_{std::move(own)}, peer_{std::move(peer)}, side_{side} {
    // What was for a predecessor is nobody's.
    for (long frames = 0; frames < waiting_frames && take_one() >= 0; ++frames) {}
  }
  MessageQueueFlow(const MessageQueueFlow&) = delete;
  MessageQueueFlow& operator=(const MessageQueueFlow&) = delete;
  ~MessageQueueFlow() override {
    const int to_device = (side_ == FlowSide::Device ? own_ : peer_).file.get();
    if (!take_turn_to_close(to_device, octet_of_closing)) return;
    if (lock_side(peer_.file.get(), octet_of_reader)) {
      if (names(own_)) (void)::mq_unlink(own_.name.c_str());
      if (names(peer_)) (void)::mq_unlink(peer_.name.c_str());
    }
    free_side(own_.file.get(), octet_of_reader);
    free_side(to_device, octet_of_closing);
  }

 private:
  [[nodiscard]] ssize_t take_one() noexcept {
    return ::mq_receive(own_.file.get(), reinterpret_cast<char*>(frame_.data()), frame_.size(), nullptr);
  }
  [[nodiscard]] bool put(Octets frame) noexcept {
    return ::mq_send(peer_.file.get(), reinterpret_cast<const char*>(frame.data()), frame.size(), 0) == 0;
  }
  [[nodiscard]] bool peer_is_there() noexcept {
    const bool there = is_locked_by_another(peer_.file.get(), octet_of_reader);
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
  FlowSide side_;
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
  // Who went last may have removed them meanwhile, and who goes has both locks for a moment.
  Result<std::unique_ptr<DataFlow>> opened =
      fail(ErrorCode::Unavailable, "message queue is made and removed all the time");
  for (int attempts = 0; attempts < opening_attempts && !opened; ++attempts) {
    HIROSCO_TRY_LET(Queue own, open_queue(side == FlowSide::Device ? to_device : to_subsystem));
    HIROSCO_TRY_LET(Queue peer, open_queue(side == FlowSide::Device ? to_subsystem : to_device));
    if (!lock_side(own.file.get(), octet_of_reader)) {
      opened = fail(ErrorCode::AlreadyExists, "this side of the flow is open");
      pause_for_peer();
    } else if (names(own) && names(peer)) {
      opened = std::make_unique<MessageQueueFlow>(std::move(own), std::move(peer), side);
    }
  }
  return opened;
}

void let_in_queues(const std::string&, Sandbox& sandbox) {
  // They lie in no folder that programs see, but where one is shown, that is the one whose files they are.
  let_write("/dev/mqueue", sandbox);
  sandbox.queues = true;
}

bool is_reached_by_queues(const std::string&, const Sandbox& sandbox) {
  // Where a folder above is open, its files are: a queue that is opened as a file is one all the same.
  return sandbox.queues || may_write("/dev/mqueue", sandbox);
}

}  // namespace hirosco
