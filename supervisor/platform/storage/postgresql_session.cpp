// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/postgresql_session.hpp"

#include <dlfcn.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "hirosco/utilities/os/clock.hpp"

namespace hirosco::supervisor {

namespace {

constexpr const char* libpq_file = "libpq.so.5";
constexpr Error no_answer{ErrorCode::Unavailable, "the server does not answer in time", 0};

template <class Function>
bool find(void* handle, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(handle, name));
  return function != nullptr;
}

std::optional<Libpq> load_from(void* handle) {
  Libpq all;
  const bool found =
      find(handle, "PQconnectStartParams", all.connect_start) && find(handle, "PQconnectPoll", all.connect_poll) &&
      find(handle, "PQstatus", all.status) && find(handle, "PQsocket", all.socket) &&
      find(handle, "PQfinish", all.finish) && find(handle, "PQsetNoticeProcessor", all.set_notices) &&
      find(handle, "PQerrorMessage", all.error_message) && find(handle, "PQsetnonblocking", all.set_nonblocking) &&
      find(handle, "PQsendQueryParams", all.send) && find(handle, "PQsetSingleRowMode", all.row_by_row) &&
      find(handle, "PQflush", all.flush) && find(handle, "PQconsumeInput", all.consume_input) &&
      find(handle, "PQisBusy", all.is_busy) && find(handle, "PQgetResult", all.get_result) &&
      find(handle, "PQresultStatus", all.result_status) && find(handle, "PQresultErrorField", all.error_field) &&
      find(handle, "PQntuples", all.rows) && find(handle, "PQgetvalue", all.value) &&
      find(handle, "PQclear", all.clear);
  return found ? std::optional{all} : std::nullopt;
}

/// What an SQLSTATE means for a log; its classes are those of the PostgreSQL manual, appendix A.
Error error_of(std::string_view state) {
  if (state == "53100") return {ErrorCode::ResourceExhausted, "the server has no space on its disk", 0};
  if (state == "42P01" || state == "3F000") return {ErrorCode::NotFound, "the table of the log is gone", 0};
  if (state == "58030" || state.starts_with("XX"))
    return {ErrorCode::SystemFailure, "the server's own storage fails", 0};
  const auto of_class = [&](std::string_view name) { return state.starts_with(name); };
  if (of_class("28") || of_class("3D") || of_class("42") || of_class("25") || of_class("0A") || of_class("22"))
    return {ErrorCode::NotPermitted, "the server refuses", 0};
  return {ErrorCode::Unavailable, "the server cannot now", 0};
}

std::string printable_line(std::string_view text) {
  std::string line;
  for (const char letter : text.substr(0, 200)) line += letter >= ' ' && letter <= '~' ? letter : ' ';
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

TimePoint now() { return SystemClock{}.now(); }

}  // namespace

Result<const Libpq*> Libpq::load() {
  static const std::optional<Libpq> loaded = []() -> std::optional<Libpq> {
    void* const handle = ::dlopen(libpq_file, RTLD_NOW | RTLD_LOCAL);
    return handle == nullptr ? std::nullopt : load_from(handle);
  }();
  if (!loaded) return fail(ErrorCode::NotFound, "libpq.so.5 is not installed");
  return &*loaded;
}

auto PostgresqlSession::connect(const std::string& connection, Duration limit)
    -> std::expected<std::unique_ptr<PostgresqlSession>, Refusal> {
  const auto libpq = Libpq::load();
  if (!libpq) return std::unexpected{Refusal{libpq.error(), "install libpq5"}};
  // What the connection string says comes later, and wins.
  constexpr std::array names{"application_name", "tcp_user_timeout", "dbname", static_cast<const char*>(nullptr)};
  const std::array values{"hirosco", "5000", connection.c_str(), static_cast<const char*>(nullptr)};
  PGconn* const begun = (*libpq)->connect_start(names.data(), values.data(), 1);
  if (begun == nullptr) return std::unexpected{Refusal{{ErrorCode::ResourceExhausted, "no memory to connect", 0}, {}}};
  // What it would print itself; what matters comes as an error.
  (*libpq)->set_notices(begun, [](void*, const char*) {}, nullptr);
  std::unique_ptr<PostgresqlSession> session{new PostgresqlSession{**libpq, begun, limit}};
  if (auto connected = session->finish_connecting(); !connected) return std::unexpected{std::move(connected.error())};
  return session;
}

PostgresqlSession::~PostgresqlSession() { libpq_.finish(connection_); }

bool PostgresqlSession::wait(bool to_write, TimePoint deadline) const {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - now());
  pollfd socket{.fd = libpq_.socket(connection_),
                .events = static_cast<short>(to_write ? POLLIN | POLLOUT : POLLIN),
                .revents = 0};
  // A signal ends the wait early, and who waits looks again.
  return left.count() > 0 && ::poll(&socket, 1, static_cast<int>(left.count())) != 0;
}

auto PostgresqlSession::refused(const PGresult* result) const -> Refusal {
  const char* const state = result == nullptr ? nullptr : libpq_.error_field(result, PG_DIAG_SQLSTATE);
  const char* const said = result == nullptr ? nullptr : libpq_.error_field(result, PG_DIAG_MESSAGE_PRIMARY);
  return {error_of(state == nullptr ? "" : state),
          printable_line(said == nullptr ? libpq_.error_message(connection_) : said)};
}

auto PostgresqlSession::finish_connecting() -> std::expected<void, Refusal> {
  const TimePoint deadline = now() + limit_;
  bool to_write = true;  // as the manual says before the first poll
  while (libpq_.status(connection_) != CONNECTION_BAD) {
    if (!wait(to_write, deadline)) return std::unexpected{Refusal{no_answer, {}}};
    const PostgresPollingStatusType asks = libpq_.connect_poll(connection_);
    if (asks == PGRES_POLLING_OK) {
      libpq_.set_nonblocking(connection_, 1);
      return {};
    }
    if (asks == PGRES_POLLING_FAILED) break;
    to_write = asks == PGRES_POLLING_WRITING;
  }
  return std::unexpected{refused()};
}

auto PostgresqlSession::send(const std::string& statement, std::span<const std::string> values)
    -> std::expected<void, Refusal> {
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  if (libpq_.send(connection_, statement.c_str(), static_cast<int>(texts.size()), nullptr, texts.data(), nullptr,
                  nullptr, 0) != 1)
    return std::unexpected{refused()};
  libpq_.row_by_row(connection_);
  const TimePoint deadline = now() + limit_;
  for (int more = libpq_.flush(connection_); more != 0; more = libpq_.flush(connection_)) {
    if (more < 0) return std::unexpected{refused()};
    if (!wait(true, deadline)) return std::unexpected{Refusal{no_answer, {}}};
    if (libpq_.consume_input(connection_) != 1) return std::unexpected{refused()};
  }
  return {};
}

auto PostgresqlSession::next_result() -> std::expected<std::unique_ptr<PGresult, decltype(&PQclear)>, Refusal> {
  const TimePoint deadline = now() + limit_;
  while (libpq_.is_busy(connection_) != 0) {
    if (!wait(false, deadline)) return std::unexpected{Refusal{no_answer, {}}};
    if (libpq_.consume_input(connection_) != 1) return std::unexpected{refused()};
  }
  return std::unique_ptr<PGresult, decltype(&PQclear)>{libpq_.get_result(connection_), libpq_.clear};
}

auto PostgresqlSession::ask(const std::string& statement, std::span<const std::string> values, std::size_t width,
                            const Row& row) -> std::expected<void, Refusal> {
  if (auto sent = send(statement, values); !sent) return sent;
  std::vector<const char*> texts(width);
  std::optional<Refusal> refusal;
  for (;;) {
    auto result = next_result();
    if (!result) return std::unexpected{std::move(result.error())};
    if (*result == nullptr) break;
    const ExecStatusType status = libpq_.result_status(result->get());
    const bool good = status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK || status == PGRES_SINGLE_TUPLE;
    if (!good && !refusal) refusal = refused(result->get());
    for (int i = 0; good && row && i < libpq_.rows(result->get()); ++i) {
      for (std::size_t column = 0; column < width; ++column)
        texts[column] = libpq_.value(result->get(), i, static_cast<int>(column));
      if (!row(texts)) return {};
    }
  }
  if (refusal) return std::unexpected{std::move(*refusal)};
  return {};
}

}  // namespace hirosco::supervisor
