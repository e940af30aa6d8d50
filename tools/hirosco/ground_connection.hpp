// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::tools {

/// A client's end of the ground link: whole packets both ways over TCP.  Blocks; for command-line tools only.
class GroundConnection {
 public:
  [[nodiscard]] static Result<GroundConnection> open(const std::string& address, std::uint16_t port);
  [[nodiscard]] Result<> send(Octets packet);
  /// Next packet; empty when none came within the time. Unavailable: the link was closed.
  [[nodiscard]] Result<std::optional<std::vector<std::byte>>> receive(Duration limit);

 private:
  explicit GroundConnection(FileDescriptor socket) : socket_{std::move(socket)} {}
  FileDescriptor socket_;
  std::vector<std::byte> stream_;
};

}  // namespace hirosco::tools
