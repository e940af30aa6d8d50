// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "hirosco/data_transfer/control/channel.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {

/// The control channel of the real set: one SOCK_SEQPACKET socket, whose inherited descriptor is the identity of a
/// subsystem (decision 2). One message is one datagram: kind u8, version u8, link u16, mode epoch u32 (big-endian), packet;
/// the memory's descriptor travels beside it. Never blocks.
/// Thread: one per direction. Realtime: one system call each; send_all() one for `most_at_once`.
class SocketChannel final : public Channel {
 public:
  static constexpr std::size_t envelope_octets = 8;
  /// Of this envelope and of what the kinds of messages mean.
  static constexpr std::uint8_t version = 1;
  static constexpr std::size_t most_at_once = 32;

  explicit SocketChannel(FileDescriptor socket) noexcept : socket_{std::move(socket)} {}
  /// Both ends, closed on exec unless they are inherited on purpose.
  [[nodiscard]] static Result<std::pair<FileDescriptor, FileDescriptor>> make_pair();

  [[nodiscard]] Result<> send(const Message& message) override;
  [[nodiscard]] std::size_t send_all(std::span<const Message> messages) override;
  /// Malformed: the peer sent what is no message; Mismatch: one of another version. It is gone with all descriptors it carried, the next one can be read.
  [[nodiscard]] Result<Found> receive(MessageBuffer& buffer) override;
  [[nodiscard]] int wait_descriptor() const noexcept override { return socket_.get(); }

 private:
  FileDescriptor socket_;
};

}  // namespace hirosco
