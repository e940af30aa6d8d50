// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>  // before Asio: Boost 1.74 forgets it
#include <vector>

#include <boost/asio.hpp>

#include "ground/shell/http_server.hpp"

namespace hirosco::ground {

namespace asio = boost::asio;
using asio::ip::tcp;
using Failure = boost::system::error_code;

/// The stream to and from a spacecraft: made again whenever it is lost, its telecommands told as not sent when they were not.
/// Thread: the loop's.
class CraftLink {
 public:
  CraftLink(asio::io_context& io, Application& application, tcp::endpoint spacecraft, std::uint16_t telecommand_port)
      : io_{io}, application_{application}, spacecraft_{std::move(spacecraft)}, telecommand_port_{telecommand_port} {}
  void open() { connect(); }
  /// For good.
  void close();
  /// False: no link, or it takes nothing.
  [[nodiscard]] bool send(Octets packet, Way way);

 private:
  void connect();
  void read();
  void write();
  void lose();
  [[nodiscard]] bool send_in_turn(Octets packet);
  void send_alone(Octets packet);

  asio::io_context& io_;
  Application& application_;
  tcp::endpoint spacecraft_;
  std::uint16_t telecommand_port_;
  asio::steady_timer pause_{io_};
  tcp::socket socket_{io_};
  bool linked_{false};
  bool writing_{false};
  bool ending_{false};
  std::array<std::byte, std::size_t{64} << 10> buffer_{};
  std::deque<std::vector<std::byte>> queue_;
  std::size_t pending_{0};
};

/// One line to a device's control socket and its answer, within 2 s; empty when nobody answers.
void ask_device(asio::io_context& io, const std::string& socket_path, const std::string& line,
                std::function<void(std::optional<std::string>)> done);

}  // namespace hirosco::ground
