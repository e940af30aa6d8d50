// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ground/api/application.hpp"
#include "ground/commands/way.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// The shell of the ground station: loop, sockets, timer. All of Boost stands behind this interface, in this folder.
namespace hirosco::ground {

class HttpServer {
 public:
  struct Options {
    std::uint16_t port{8080};          ///< on the loopback address, no other
    std::string spacecraft{"127.0.0.1:10015"};
    std::uint16_t telecommand_port{10025};  ///< of the spacecraft, beside that for telemetry
    Duration tick_period{std::chrono::milliseconds{50}};
    /// End when standard input ends: the process that started us is gone.
    bool end_with_input{false};
  };
  /// When all are taken, a newcomer has the place of the one that has asked nothing for the longest time.
  static constexpr std::size_t most_connections = 64;
  /// WebSockets among them: pages that only look do not keep out a request.
  static constexpr std::size_t most_peers = 48;
  static constexpr std::size_t most_body_octets = std::size_t{64} << 10;

  /// Unavailable: the port is taken.
  [[nodiscard]] static Result<std::unique_ptr<HttpServer>> listen(const Options& options);
  virtual ~HttpServer() = default;
  /// Port that was taken; of interest when 0 was asked for.
  [[nodiscard]] virtual std::uint16_t port() const = 0;
  /// Serves until SIGINT, SIGTERM or stop().
  virtual void run(Application& application) = 0;
  virtual void stop() = 0;

  // --- for the application, from the thread of run() -----------------------------------------------------------------
  /// To the spacecraft; false without a link, or when it takes nothing. Alone: tried past the link and without one.
  [[nodiscard]] virtual bool send(Octets packet, Way way) = 0;
  /// One line to a UNIX stream socket and its answer, within 2 s; empty when nobody answers.
  virtual void ask(const std::string& socket_path, const std::string& line,
                   std::function<void(std::optional<std::string>)> done) = 0;
};

}  // namespace hirosco::ground
