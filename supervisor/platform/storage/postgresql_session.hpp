// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <libpq-fe.h>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::supervisor {

/// The functions of libpq that we call. It is loaded when a log is in a server, so that nobody else's flight locks it in memory.
struct Libpq {
  decltype(&PQconnectStartParams) connect_start{};
  decltype(&PQconnectPoll) connect_poll{};
  decltype(&PQstatus) status{};
  decltype(&PQsocket) socket{};
  decltype(&PQfinish) finish{};
  decltype(&PQsetNoticeProcessor) set_notices{};
  decltype(&PQerrorMessage) error_message{};
  decltype(&PQsetnonblocking) set_nonblocking{};
  decltype(&PQsendQueryParams) send{};
  decltype(&PQsetSingleRowMode) row_by_row{};
  decltype(&PQflush) flush{};
  decltype(&PQconsumeInput) consume_input{};
  decltype(&PQisBusy) is_busy{};
  decltype(&PQgetResult) get_result{};
  decltype(&PQresultStatus) result_status{};
  decltype(&PQresultErrorField) error_field{};
  decltype(&PQntuples) rows{};
  decltype(&PQgetvalue) value{};
  decltype(&PQclear) clear{};

  /// NotFound: it is not installed.  Stays loaded for the life of the process.
  [[nodiscard]] static Result<const Libpq*> load();
};

/// One connection to a server; every wait ends at a deadline, after which the connection is of no use. Thread: one.
class PostgresqlSession {
 public:
  /// Values of one row, as text; true = go on.
  using Row = std::function<bool(std::span<const char* const>)>;
  struct Refusal {
    Error error{};
    std::string words{};  ///< what the server said, printable
  };

  [[nodiscard]] static std::expected<std::unique_ptr<PostgresqlSession>, Refusal> connect(const std::string& connection,
                                                                                          Duration limit);
  ~PostgresqlSession();
  PostgresqlSession(const PostgresqlSession&) = delete;
  PostgresqlSession& operator=(const PostgresqlSession&) = delete;

  /// Sends one statement and hands on its rows, `width` values each. A `row` that has enough leaves the session unusable.
  [[nodiscard]] std::expected<void, Refusal> ask(const std::string& statement, std::span<const std::string> values,
                                                 std::size_t width = 0, const Row& row = {});

 private:
  PostgresqlSession(const Libpq& libpq, PGconn* connection, Duration limit)
      : libpq_{libpq}, connection_{connection}, limit_{limit} {}
  /// Waits for the socket; false at the deadline.
  [[nodiscard]] bool wait(bool to_write, TimePoint deadline) const;
  [[nodiscard]] Refusal refused(const PGresult* result = nullptr) const;
  [[nodiscard]] std::expected<void, Refusal> finish_connecting();
  [[nodiscard]] std::expected<void, Refusal> send(const std::string& statement, std::span<const std::string> values);
  /// The next result, null behind the last.
  [[nodiscard]] std::expected<std::unique_ptr<PGresult, decltype(&PQclear)>, Refusal> next_result();

  const Libpq& libpq_;
  PGconn* connection_;
  Duration limit_;
};

}  // namespace hirosco::supervisor
