// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/shell/craft_link.hpp"

#include <algorithm>
#include <memory>

namespace hirosco::ground {

namespace {
constexpr auto device_limit = std::chrono::seconds{2};
/// Of telecommands in the kernel: what became of those nobody can tell when the link is lost, so that few may be there.
constexpr int send_octets = 4096;
constexpr auto errand_limit = std::chrono::seconds{2};
constexpr auto reconnect_pause = std::chrono::milliseconds{300};
constexpr std::size_t most_waiting_telecommands = std::size_t{256} << 10;
}  // namespace

void CraftLink::close() {
  ending_ = true;
  pause_.cancel();
  Failure ignored;
  socket_.close(ignored);
}

void CraftLink::connect() {
  socket_ = tcp::socket{io_};
  Failure unlimited;
  socket_.open(spacecraft_.protocol(), unlimited);
  socket_.set_option(asio::socket_base::send_buffer_size{send_octets}, unlimited);
  socket_.async_connect(spacecraft_, [this](Failure failed) {
    if (ending_) return;
    if (failed) return lose();
    Failure ignored;
    socket_.set_option(tcp::no_delay{true}, ignored);
    linked_ = true;
    application_.link_up();
    read();
  });
}

void CraftLink::read() {
  socket_.async_read_some(asio::buffer(buffer_), [this](Failure failed, std::size_t octets) {
    if (ending_) return;
    if (failed || !application_.link_received(Octets{buffer_}.first(octets))) return lose();
    read();
  });
}

void CraftLink::lose() {
  Failure ignored;
  socket_.close(ignored);
  // What the next link would bring late is told as not sent instead: its sender may want something else by then.
  for (const auto& packet : std::exchange(queue_, {})) application_.not_sent(packet);
  pending_ = 0;
  if (linked_) application_.link_down();
  linked_ = false;
  pause_.expires_after(reconnect_pause);
  pause_.async_wait([this](Failure failed) {
    if (!failed && !ending_) connect();
  });
}

bool CraftLink::send(Octets packet, Way way) {
  if (way == Way::InTurn) return send_in_turn(packet);
  // Also without a link: that port may take what the other, whose places are all taken, does not.
  send_alone(packet);
  return true;
}

bool CraftLink::send_in_turn(Octets packet) {
  if (!linked_ || pending_ + packet.size() > most_waiting_telecommands) return false;
  pending_ += packet.size();
  queue_.emplace_back(packet.begin(), packet.end());
  if (!writing_) write();
  return true;
}

void CraftLink::write() {
  writing_ = true;
  auto packet = std::make_shared<std::vector<std::byte>>(std::move(queue_.front()));
  queue_.pop_front();
  asio::async_write(socket_, asio::buffer(*packet), [this, packet](Failure failed, std::size_t) {
    writing_ = false;
    // A failure shows to the reader too, which makes a new link.
    if (failed && !ending_) application_.not_sent(*packet);
    pending_ -= std::min(pending_, packet->size());
    if (linked_ && !queue_.empty()) write();
  });
}

namespace {

/// A connection for one telecommand.
struct Errand {
  explicit Errand(asio::io_context& io) : socket{io}, limit{io} {}
  tcp::socket socket;
  asio::steady_timer limit;
  std::vector<std::byte> packet;
  std::array<std::byte, 1> nothing{};
};

}  // namespace

void CraftLink::send_alone(Octets packet) {
  auto errand = std::make_shared<Errand>(io_);
  errand->packet.assign(packet.begin(), packet.end());
  errand->limit.expires_after(errand_limit);
  errand->limit.async_wait([errand](Failure failed) {
    Failure ignored;
    if (!failed) errand->socket.close(ignored);
  });
  // Without that port the link has to do.
  const auto or_in_turn = [this, errand] {
    errand->limit.cancel();
    if (!ending_ && !send_in_turn(errand->packet)) application_.not_sent(errand->packet);
  };
  errand->socket.async_connect({spacecraft_.address(), telecommand_port_}, [errand, or_in_turn](Failure failed) {
    if (failed) return or_in_turn();
    asio::async_write(errand->socket, asio::buffer(errand->packet), [errand, or_in_turn](Failure lost, std::size_t) {
      if (lost) return or_in_turn();
      Failure ignored;
      errand->socket.shutdown(tcp::socket::shutdown_send, ignored);
      // The other side ends it when it has taken what came.
      errand->socket.async_read_some(asio::buffer(errand->nothing),
                                     [errand](Failure, std::size_t) { errand->limit.cancel(); });
    });
  });
}

// --- devices ---------------------------------------------------------------------------------------------------------

namespace {

/// One question to one control socket.
struct Question final : std::enable_shared_from_this<Question> {
  explicit Question(asio::io_context& io) : socket{io}, timer{io} {}
  void finish(std::optional<std::string> result) {
    if (!done) return;
    const auto tell = std::exchange(done, nullptr);
    Failure ignored;
    socket.close(ignored);
    timer.cancel();
    tell(std::move(result));
  }
  asio::local::stream_protocol::socket socket;
  asio::steady_timer timer;
  std::string line;
  std::string answer;
  std::function<void(std::optional<std::string>)> done;
};

}  // namespace

void ask_device(asio::io_context& io, const std::string& socket_path, const std::string& line,
                std::function<void(std::optional<std::string>)> done) {
  constexpr std::size_t longest_path = 107;
  if (socket_path.size() > longest_path) return done(std::nullopt);
  auto question = std::make_shared<Question>(io);
  question->line = line + "\n";
  question->done = std::move(done);
  question->timer.expires_after(device_limit);
  question->timer.async_wait([question](Failure failed) {
    if (!failed) question->finish(std::nullopt);
  });
  question->socket.async_connect(asio::local::stream_protocol::endpoint{socket_path}, [question](Failure failed) {
    if (failed) return question->finish(std::nullopt);
    asio::async_write(question->socket, asio::buffer(question->line), [question](Failure lost, std::size_t) {
      if (lost) return question->finish(std::nullopt);
      asio::async_read_until(question->socket, asio::dynamic_buffer(question->answer, std::size_t{4096}), '\n',
                             [question](Failure cut, std::size_t octets) {
                               if (cut) return question->finish(std::nullopt);
                               question->finish(question->answer.substr(0, octets - 1));
                             });
    });
  });
}

}  // namespace hirosco::ground
