// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "hirosco/data_transfer/channel/envelope.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {

/// The control channel of the real set: one SOCK_SEQPACKET socket, whose inherited descriptor is the identity of a
/// subsystem (decision 2). One message is one datagram: envelope and packet; the memory's descriptor travels beside it. Never
/// blocks.
/// Thread: one per direction. Realtime: one system call each; send_all() one for `most_at_once`.
class SocketChannel final : public Channel {
 public:
  static constexpr std::size_t most_at_once = 32;

  /// What becomes of memory that the peer sends beside its packets. Dropped: the system lets go of it, however much there is of it, and the
  /// packets are read; for who uses none, and reads many.
  enum class Memory : std::uint8_t { Taken, Dropped };

  explicit SocketChannel(FileDescriptor socket, Memory memory = Memory::Taken) noexcept
      : socket_{std::move(socket)}, memory_{memory} {}
  /// Both ends, closed on exec unless they are inherited on purpose. `kb`: how much of the system's memory may wait each way; left out: as
  /// the system has it. ResourceExhausted, with what it grants in octets: it grants less.
  [[nodiscard]] static Result<std::pair<FileDescriptor, FileDescriptor>> make_pair(
      std::optional<std::uint32_t> kb = std::nullopt);

  [[nodiscard]] Result<> send(const Message& message) override;
  [[nodiscard]] std::size_t send_all(std::span<const Message> messages) override;
  /// Malformed: the peer sent what is no message; Mismatch: one of another version, which is the error's number. It is gone
  /// with all descriptors it carried, the next one can be read.
  [[nodiscard]] Result<Found> receive(MessageBuffer& buffer) override;
  /// Octets of the system's memory.
  [[nodiscard]] Fill outbound() noexcept override;
  [[nodiscard]] int wait_descriptor() const noexcept override { return socket_.get(); }
  /// Of the newest message that was refused for it; empty: none was.
  [[nodiscard]] std::optional<std::uint8_t> foreign_version() const noexcept { return foreign_version_; }

 private:
  FileDescriptor socket_;
  Memory memory_;
  std::optional<std::uint8_t> foreign_version_;
};

}  // namespace hirosco
