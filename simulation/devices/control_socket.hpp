// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::simulation {

/// Where people and tools reach into a simulated world: a UNIX stream socket, one line of text per request, one line per
/// answer. At most four clients, lines of at most 255 characters; who breaks the rule is disconnected.
/// Realtime: allocates. Thread: one.
class ControlSocket {
 public:
  ControlSocket() = default;
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// Listens at `path` (at most 107 octets); a socket that nobody serves any more is replaced.
  [[nodiscard]] Result<> listen(const std::string& path);
  /// Answers what has come, without waiting. `answer` returns one line without its end.
  void serve(const std::function<std::string(std::string_view)>& answer);

 private:
  static constexpr std::size_t most_clients = 4;
  static constexpr std::size_t longest_line = 255;
  struct Client {
    FileDescriptor socket;
    std::string pending;
  };
  void accept_clients();
  void serve_client(Client& client, const std::function<std::string(std::string_view)>& answer);

  FileDescriptor listener_;
  std::string path_;
  std::array<Client, most_clients> clients_;
};

}  // namespace hirosco::simulation
