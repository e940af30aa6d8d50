// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/utilities/octets.hpp"

/// What stands between the shell, which has the sockets, and everything behind it: requests, pages, the spacecraft's stream.
namespace hirosco::ground {

struct HttpRequest {
  std::string method;
  std::string target;  ///< path and query as sent
  std::map<std::string, std::string> headers;  ///< names in small letters
  std::string body;
};
struct HttpResponse {
  unsigned status{200};
  std::string type{"application/json"};
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
};

/// The other end of one WebSocket.
class Peer {
 public:
  virtual ~Peer() = default;
  /// Queues a message; never blocks.
  virtual void send(std::string text) = 0;
  /// Octets that the network has not yet taken.
  [[nodiscard]] virtual std::size_t pending_octets() const = 0;
  virtual void close(std::uint16_t code, const std::string& reason) = 0;
};

/// What the server serves. Every call comes from the thread of HttpServer::run().
class Application {
 public:
  virtual ~Application() = default;
  /// Answers now or later, once.
  virtual void handle(const HttpRequest& request, std::function<void(HttpResponse)> respond) = 0;
  /// A WebSocket asks to be opened: empty lets it in.
  [[nodiscard]] virtual std::optional<HttpResponse> refuse_socket(const HttpRequest& request) = 0;
  virtual void opened(const HttpRequest& request, Peer& peer) = 0;
  virtual void received(const Peer& peer, const std::string& text) = 0;
  virtual void closed(const Peer& peer) = 0;
  /// The spacecraft's stream.
  virtual void link_up() = 0;
  virtual void link_down() = 0;
  /// A telecommand that send() took and that has not left, or not as a whole.
  virtual void not_sent(Octets packet) = 0;
  /// False: close the link and make a new one.
  [[nodiscard]] virtual bool link_received(Octets octets) = 0;
  virtual void tick() = 0;
};

}  // namespace hirosco::ground
