// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/shell/http_server.hpp"

#include <utility>  // before Asio: Boost 1.74 forgets it

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <set>

#include "ground/shell/craft_link.hpp"
#include "ground/shell/gzip.hpp"

/// One thread, nothing blocks; every queue has a limit.
namespace hirosco::ground {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
constexpr auto request_limit = std::chrono::seconds{30};
constexpr auto accept_pause = std::chrono::milliseconds{300};
constexpr std::size_t most_header_octets = std::size_t{16} << 10;
constexpr std::size_t most_message_octets = std::size_t{4} << 10;

class Server;

[[nodiscard]] HttpRequest plain(const http::request<http::string_body>& request) {
  HttpRequest copy;
  copy.method = std::string{request.method_string()};
  copy.target = std::string{request.target()};
  copy.body = request.body();
  for (const auto& field : request) {
    std::string name{field.name_string()};
    for (char& letter : name) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    // Two of one name could mean two things to two readers: neither counts.
    const auto [known, first] = copy.headers.emplace(name, std::string{field.value()});
    if (!first) known->second = "\n";
  }
  return copy;
}

[[nodiscard]] http::response<http::string_body> boxed(const HttpResponse& response, unsigned version, bool keep_alive,
                                                      std::string_view accepts) {
  http::response<http::string_body> message{static_cast<http::status>(response.status), version};
  message.set(http::field::content_type, response.type);
  for (const auto& [name, value] : response.headers) message.set(name, value);
  const bool may_zip = message.count(http::field::content_encoding) == 0 && takes_gzip(accepts);
  if (auto small = may_zip ? zipped(response.body) : std::nullopt) {
    message.set(http::field::content_encoding, "gzip");
    message.set(http::field::vary, "Accept-Encoding");
    message.body() = std::move(*small);
  } else {
    message.body() = response.body;
  }
  message.keep_alive(keep_alive);
  message.prepare_payload();
  return message;
}

[[nodiscard]] HttpResponse brief(unsigned status, const std::string& text) {
  return {.status = status, .body = R"({"error":")" + text + R"("})", .headers = {}};
}

/// The answer to a request that cannot be read; empty: nobody waits for one.
[[nodiscard]] std::optional<HttpResponse> unreadable(Failure failed) {
  if (failed == http::error::body_limit) return brief(413, "more than 64 KiB");
  if (failed == http::error::header_limit || failed == http::error::buffer_overflow)
    return brief(431, "more than 16 KiB before the body");
  if (failed == http::error::end_of_stream || failed == http::error::partial_message) return std::nullopt;
  const Failure not_understood = http::error::bad_method;
  if (failed.category() == not_understood.category()) return brief(400, "this is not HTTP");
  return std::nullopt;
}

/// The answer to a head whose body cannot be told from the next request, or that expects what we do not do; empty: read on.
[[nodiscard]] std::optional<HttpResponse> unanswerable(const http::request<http::string_body>& request) {
  const auto encodings = request.count(http::field::transfer_encoding);
  const bool chunked = encodings == 1 && beast::iequals(request[http::field::transfer_encoding], "chunked");
  if (encodings != 0 && !chunked) return brief(501, "of the transfer encodings chunked is known, alone");
  if (encodings != 0 && request.version() < 11) return brief(400, "HTTP/1.0 has no transfer encodings");
  if (encodings != 0 && request.count(http::field::content_length) != 0) return brief(400, "two lengths of one body");
  const auto expected = request.count(http::field::expect);
  if (expected > 1 || (expected == 1 && !beast::iequals(request[http::field::expect], "100-continue")))
    return brief(417, "of what may be expected 100-continue is known");
  return std::nullopt;
}

/// One WebSocket. Lives while the server lists it or a handler of it is pending.
class SocketPeer final : public Peer, public std::enable_shared_from_this<SocketPeer> {
 public:
  SocketPeer(Server& server, beast::tcp_stream stream) : server_{server}, socket_{std::move(stream)} {}
  void accept(http::request<http::string_body> request);
  void send(std::string text) override;
  [[nodiscard]] std::size_t pending_octets() const override { return pending_; }
  void close(std::uint16_t code, const std::string& reason) override;
  void drop();

 private:
  void read();
  void write();
  void ended();

  Server& server_;
  websocket::stream<beast::tcp_stream> socket_;
  http::request<http::string_body> request_;
  beast::flat_buffer buffer_;
  std::deque<std::string> queue_;
  std::size_t pending_{0};
  bool open_{false};
  bool writing_{false};
  bool closing_{false};
};

/// One HTTP connection: a request at a time.
class Connection final : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Server& server, tcp::socket socket) : server_{server}, stream_{std::move(socket)} {}
  ~Connection();
  void read();
  void drop();
  /// Since when the next request is waited for; empty: one is being answered, or the connection ends.
  [[nodiscard]] const std::optional<std::chrono::steady_clock::time_point>& waits_since() const { return waits_since_; }

 private:
  /// Tells who waits for it that the body may come.
  void encourage();
  void read_body();
  void unread(Failure failed);
  void handle();
  void respond(const HttpResponse& response);
  /// The last answer on this connection: what follows is not known to be a request.
  void refuse(const HttpResponse& refusal);

  Server& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{most_header_octets + HttpServer::most_body_octets};
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::response<http::string_body>> response_;
  std::optional<http::response<http::empty_body>> go_on_;
  bool last_{false};
  std::optional<std::chrono::steady_clock::time_point> waits_since_;
};

class Server final : public HttpServer {
 public:
  explicit Server(Options options) : options_{std::move(options)} {}
  [[nodiscard]] Result<> open();
  [[nodiscard]] std::uint16_t port() const override { return port_; }
  void run(Application& application) override;
  void stop() override {
    asio::post(io_, [this] { shut(); });
  }
  [[nodiscard]] bool send(Octets packet, Way way) override { return link_->send(packet, way); }
  void ask(const std::string& socket_path, const std::string& line,
           std::function<void(std::optional<std::string>)> done) override {
    ask_device(io_, socket_path, line, std::move(done));
  }

  [[nodiscard]] Application& application() noexcept { return *application_; }
  std::set<std::shared_ptr<SocketPeer>> peers;
  std::set<Connection*> connections;
  asio::io_context& io() noexcept { return io_; }

 private:
  void accept();
  [[nodiscard]] bool displace();
  void tick();
  void shut();
  void watch_input();

  Options options_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  asio::steady_timer ticker_{io_};
  asio::steady_timer accept_pause_{io_};
  asio::signal_set signals_{io_, SIGINT, SIGTERM};
  asio::posix::stream_descriptor input_{io_};
  std::array<char, 64> input_buffer_{};
  Application* application_{nullptr};
  std::uint16_t port_{0};
  bool ending_{false};

  tcp::endpoint spacecraft_;
  std::optional<CraftLink> link_;
};

// --- WebSocket -------------------------------------------------------------------------------------------------------

void SocketPeer::accept(http::request<http::string_body> request) {
  request_ = std::move(request);
  beast::get_lowest_layer(socket_).expires_never();
  auto limits = websocket::stream_base::timeout::suggested(beast::role_type::server);
  limits.idle_timeout = std::chrono::seconds{30};
  limits.keep_alive_pings = true;
  socket_.set_option(limits);
  socket_.read_message_max(most_message_octets);
  socket_.text(true);
  // One message, one frame: simple clients need not put pieces together.
  socket_.auto_fragment(false);
  server_.peers.insert(shared_from_this());
  socket_.async_accept(request_, [self = shared_from_this()](Failure failed) {
    if (failed) {
      self->server_.peers.erase(self);
      return;
    }
    self->open_ = true;
    self->server_.application().opened(plain(self->request_), *self);
    self->read();
  });
}

void SocketPeer::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](Failure failed, std::size_t) {
    if (failed) return self->ended();
    const std::string text = beast::buffers_to_string(self->buffer_.data());
    self->buffer_.consume(self->buffer_.size());
    self->server_.application().received(*self, text);
    self->read();
  });
}

void SocketPeer::send(std::string text) {
  if (!open_ || closing_) return;
  pending_ += text.size();
  queue_.push_back(std::move(text));
  if (!writing_) write();
}

void SocketPeer::write() {
  writing_ = true;
  socket_.async_write(asio::buffer(queue_.front()), [self = shared_from_this()](Failure failed, std::size_t) {
    self->writing_ = false;
    if (failed) return self->ended();
    self->pending_ -= self->queue_.front().size();
    self->queue_.pop_front();
    if (!self->queue_.empty()) self->write();
  });
}

void SocketPeer::close(std::uint16_t code, const std::string& reason) {
  if (closing_) return;
  closing_ = true;
  // Who takes nothing would not take a closing word either: it is said if there is room, and the line is cut.
  websocket::close_reason why{static_cast<websocket::close_code>(code)};
  why.reason = reason.substr(0, 100);
  if (!writing_) socket_.async_close(why, [self = shared_from_this()](Failure) {});
  auto timer = std::make_shared<asio::steady_timer>(server_.io(), std::chrono::milliseconds{500});
  timer->async_wait([self = shared_from_this(), timer](Failure) { self->drop(); });
}

void SocketPeer::drop() { beast::get_lowest_layer(socket_).close(); }

void SocketPeer::ended() {
  if (!open_) return;
  open_ = false;
  drop();
  server_.application().closed(*this);
  server_.peers.erase(shared_from_this());
}

// --- HTTP ------------------------------------------------------------------------------------------------------------

Connection::~Connection() { server_.connections.erase(this); }

void Connection::read() {
  parser_.emplace();
  parser_->header_limit(most_header_octets);
  parser_->body_limit(HttpServer::most_body_octets);
  stream_.expires_after(request_limit);
  waits_since_ = std::chrono::steady_clock::now();
  http::async_read_header(stream_, buffer_, *parser_, [self = shared_from_this()](Failure failed, std::size_t) {
    if (failed) return self->unread(failed);
    if (const auto refusal = unanswerable(self->parser_->get())) return self->refuse(*refusal);
    self->encourage();
  });
}

void Connection::encourage() {
  const auto& request = parser_->get();
  if (parser_->is_done() || request.version() < 11 || request.count(http::field::expect) == 0) return read_body();
  go_on_.emplace(http::status::continue_, 11);
  http::async_write(stream_, *go_on_, [self = shared_from_this()](Failure failed, std::size_t) {
    if (!failed) self->read_body();
  });
}

void Connection::read_body() {
  http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](Failure failed, std::size_t) {
    if (failed) return self->unread(failed);
    self->waits_since_.reset();
    self->handle();
  });
}

void Connection::unread(Failure failed) {
  if (const auto refusal = unreadable(failed)) refuse(*refusal);
  else waits_since_.reset();
}

void Connection::refuse(const HttpResponse& refusal) {
  waits_since_.reset();
  last_ = true;
  respond(refusal);
}

void Connection::drop() {
  waits_since_.reset();
  stream_.close();
}

void Connection::handle() {
  const HttpRequest request = plain(parser_->get());
  if (websocket::is_upgrade(parser_->get())) {
    const auto answer_late = [self = shared_from_this()](const HttpResponse& response) { self->respond(response); };
    if (server_.application().refuse_socket(request)) return server_.application().handle(request, answer_late);
    if (server_.peers.size() >= HttpServer::most_peers) return respond(brief(503, "too many pages are open"));
    return std::make_shared<SocketPeer>(server_, std::move(stream_))->accept(parser_->release());
  }
  // Whoever answers later keeps the connection alive until then.
  server_.application().handle(request,
                               [self = shared_from_this()](const HttpResponse& response) { self->respond(response); });
}

void Connection::respond(const HttpResponse& response) {
  const bool keep = !last_ && parser_->is_done() && parser_->keep_alive();
  const unsigned version = parser_->is_header_done() ? parser_->get().version() : 11;
  const auto accepts = parser_->is_header_done() ? parser_->get()[http::field::accept_encoding] : beast::string_view{};
  response_ = boxed(response, version, keep, {accepts.data(), accepts.size()});
  if (parser_->is_header_done() && parser_->get().method() == http::verb::head) response_->body().clear();
  stream_.expires_after(request_limit);
  http::async_write(stream_, *response_, [self = shared_from_this(), keep](Failure failed, std::size_t) {
    if (!failed && keep) return self->read();
    Failure ignored;
    self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  });
}

// --- server ----------------------------------------------------------------------------------------------------------

Result<> Server::open() {
  const auto colon = options_.spacecraft.rfind(':');
  Failure failed;
  const auto address = asio::ip::make_address(options_.spacecraft.substr(0, colon), failed);
  const int port = colon == std::string::npos ? 0 : std::atoi(options_.spacecraft.c_str() + colon + 1);
  if (failed || port <= 0 || port > 65'535)
    return fail(ErrorCode::InvalidArgument, "the spacecraft's address is not ADDRESS:PORT");
  spacecraft_ = {address, static_cast<std::uint16_t>(port)};
  const tcp::endpoint own{asio::ip::address_v4::loopback(), options_.port};
  if (acceptor_.open(own.protocol(), failed); failed) return fail(ErrorCode::SystemFailure, "socket", failed.value());
  acceptor_.set_option(asio::socket_base::reuse_address{true}, failed);
  if (acceptor_.bind(own, failed); failed) return fail(ErrorCode::Unavailable, "the port is taken", failed.value());
  if (acceptor_.listen(asio::socket_base::max_listen_connections, failed); failed)
    return fail(ErrorCode::Unavailable, "the port is taken", failed.value());
  port_ = acceptor_.local_endpoint().port();
  return ok();
}

void Server::run(Application& application) {
  application_ = &application;
  signals_.async_wait([this](Failure failed, int) {
    if (!failed) shut();
  });
  if (options_.end_with_input) {
    Failure failed;
    input_.assign(0, failed);
    if (!failed) watch_input();
  }
  accept();
  link_.emplace(io_, application, spacecraft_, options_.telecommand_port);
  link_->open();
  ticker_.expires_after(options_.tick_period);
  tick();
  io_.run();
  // Their sockets must not outlive the loop.
  for (const auto& peer : peers) application.closed(*peer);
  peers.clear();
}

void Server::watch_input() {
  input_.async_read_some(asio::buffer(input_buffer_), [this](Failure failed, std::size_t) {
    if (failed == asio::error::operation_aborted) return;
    if (failed) return shut();
    watch_input();
  });
}

void Server::shut() {
  if (ending_) return;
  ending_ = true;
  Failure ignored;
  acceptor_.close(ignored);
  signals_.cancel(ignored);
  ticker_.cancel();
  accept_pause_.cancel();
  link_->close();
  if (input_.is_open()) static_cast<void>(input_.release());
  for (const auto& peer : std::set{peers}) peer->drop();
  for (Connection* connection : std::set{connections}) connection->drop();
  // What is pending ends now; handlers of closed sockets are not waited for.
  io_.stop();
}

void Server::accept() {
  acceptor_.async_accept([this](Failure failed, tcp::socket socket) {
    if (ending_) return;
    // Out of descriptors, say: asking again at once would take a processor.
    if (failed) {
      accept_pause_.expires_after(accept_pause);
      return accept_pause_.async_wait([this](Failure) {
        if (!ending_) accept();
      });
    }
    const bool full = connections.size() + peers.size() >= most_connections;
    if (!full || displace()) {
      Failure ignored;
      socket.set_option(tcp::no_delay{true}, ignored);
      auto connection = std::make_shared<Connection>(*this, std::move(socket));
      connections.insert(connection.get());
      connection->read();
    }
    accept();
  });
}

bool Server::displace() {
  Connection* idle = nullptr;
  for (Connection* connection : connections)
    if (connection->waits_since() && (idle == nullptr || connection->waits_since() < idle->waits_since()))
      idle = connection;
  if (idle != nullptr) idle->drop();
  return idle != nullptr;
}

void Server::tick() {
  ticker_.async_wait([this](Failure failed) {
    if (failed || ending_) return;
    application_->tick();
    // A late tick is not made up for.
    const auto next =
        ticker_.expiry() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(options_.tick_period);
    ticker_.expires_at(std::max(next, std::chrono::steady_clock::now()));
    tick();
  });
}

}  // namespace

Result<std::unique_ptr<HttpServer>> HttpServer::listen(const Options& options) {
  auto server = std::make_unique<Server>(options);
  HIROSCO_TRY(server->open());
  return server;
}

}  // namespace hirosco::ground
