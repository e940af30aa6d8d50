// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/channel/channel.hpp"
#include "hirosco/data_transfer/channel/stream_frame.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What the two sides of a stream hold of each other besides messages: few words, of which the newest alone count.
class StreamWords {
 public:
  static constexpr std::size_t max_octets = 2048;
  virtual ~StreamWords() = default;
  [[nodiscard]] virtual StreamFrameKind told_kind() const noexcept = 0;
  [[nodiscard]] virtual StreamFrameKind heard_kind() const noexcept = 0;
  /// Ours as they are now.
  virtual void tell(OctetWriter& words) noexcept = 0;
  /// The first so many octets of ours go ahead of every message as soon as they change; the others may be a period old.
  [[nodiscard]] virtual std::size_t urgent_octets() const noexcept = 0;
  /// Theirs. Malformed: they are none.
  [[nodiscard]] virtual Result<> hear(Octets words) = 0;
};

/// A control channel over a stream of octets (a UNIX or TCP socket), for a member that shares no memory with its supervisor:
/// messages in frames, and words beside them. Memory does not cross it. A frame that is damaged or of another version ends it:
/// in a stream there is no place from which to go on. Never blocks. Thread: one.
class StreamChannel final : public Channel {
 public:
  /// At most this old is what the peer knows of words that are not urgent.
  static constexpr Duration words_period = std::chrono::milliseconds{10};

  /// `socket` does not block.
  StreamChannel(FileDescriptor socket, StreamWords& words);
  /// Both ends of a stream inside one computer, closed on exec.
  [[nodiscard]] static Result<std::pair<FileDescriptor, FileDescriptor>> make_pair();

  /// Takes what has come, sends what has waited, and our words where they are due.
  void step(TimePoint now);
  /// Nothing can be sent any more.
  [[nodiscard]] bool closed() const noexcept { return ended_.has_value(); }

  /// InvalidArgument: a packet that is too long, or memory. Otherwise as every channel.
  [[nodiscard]] Result<> send(const Message& message) override;
  /// Malformed, Mismatch: why the stream is not read any more; once, after that it is Unavailable.
  [[nodiscard]] Result<Found> receive(MessageBuffer& buffer) override;
  [[nodiscard]] int wait_descriptor() const noexcept override { return socket_.get(); }

 private:
  static constexpr std::size_t out_octets = std::size_t{1} << 16;
  static constexpr std::size_t in_octets = 2 * max_stream_frame_octets;
  /// Messages that wait to be received; words behind them are heard at once all the same.
  static constexpr std::size_t most_messages = 256;

  [[nodiscard]] Result<> put(StreamFrameKind kind, Octets head, Octets rest);
  /// False: they still wait.
  bool send_words(bool due);
  void flush();
  void take_in();
  [[nodiscard]] Result<> take(const StreamFrame& frame);
  /// False: there is nothing at present.
  bool read_more();
  void end(const Error& why) noexcept;

  FileDescriptor socket_;
  StreamWords& words_;
  std::vector<std::byte> out_;
  std::size_t out_begin_{0}, out_end_{0};
  std::vector<std::byte> in_;
  std::size_t in_begin_{0}, in_end_{0};
  struct Stored {
    Message message;  ///< without its packet
    std::vector<std::byte> packet;
  };
  std::deque<Stored> messages_;
  std::vector<std::byte> urgent_told_;
  TimePoint words_due_{};
  std::optional<Error> ended_;  ///< why
  bool end_told_{false};
};

}  // namespace hirosco
