// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/postgresql_database.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <utility>

#include "supervisor/platform/storage/postgresql_session.hpp"

namespace hirosco::supervisor {

namespace {

using Refusal = PostgresqlSession::Refusal;
template <class T>
using Answer = std::expected<T, Refusal>;

constexpr const char* version_text = "HIROSCO packet log, version 1";

/// What makes a session fit for a log: answers are durable, and a statement that we have given up ends by itself.
constexpr const char* set_up_session =
    "SELECT set_config('synchronous_commit', CASE current_setting('synchronous_commit') WHEN 'off' THEN 'on' ELSE "
    "current_setting('synchronous_commit') END, false), set_config('statement_timeout', $1, false), "
    "current_setting('fsync'), set_config('bytea_output', 'hex', false), set_config('lock_timeout', $2, false)";
/// Who writes a log holds this for as long as its session lives: what one that is gone had sent last is carried out to its end, or not at all,
/// before another one writes, or asks how far the log has come (docs/adr/0233). The first number is "HIRO".
constexpr const char* take_turn = "SELECT pg_advisory_lock(1212764751, hashtext($1))";
constexpr const char* turn_is_taken = "SELECT set_config('lock_timeout', '0', false)";
/// A session that nobody is at the other end of any more, of which its server has not heard, as of a computer that has lost its network.
constexpr const char* end_whose_turn_it_is =
    "SELECT pg_terminate_backend(pid) FROM pg_locks WHERE locktype = 'advisory' AND granted AND classid = 1212764751 "
    "AND "
    "objid::bigint = (hashtext($1)::bigint & 4294967295) AND database = (SELECT oid FROM pg_database WHERE datname = "
    "current_database())";
constexpr const char* make_table =
    "CREATE TABLE IF NOT EXISTS hirosco_log (log text NOT NULL, run bigint NOT NULL, number bigint NOT NULL, stored "
    "bigint "
    "NOT NULL, monotonic bigint NOT NULL, kind text NOT NULL, source integer NOT NULL, peer integer NOT NULL, lost "
    "bigint "
    "NOT NULL, note text NOT NULL, packet bytea NOT NULL, apid integer, service integer, subtype integer, PRIMARY KEY "
    "(log, "
    "run, number))";
constexpr const char* mark_table = "COMMENT ON TABLE hirosco_log IS 'HIROSCO packet log, version 1'";
constexpr const char* version_of_table = "SELECT obj_description(to_regclass('hirosco_log'), 'pg_class')";

/// One statement, so that all of a batch or nothing is stored. It answers how many of its numbers stand there in other words (then
/// it stores nothing), the first of these, and whether the last record of the batch before is there still.
constexpr const char* store_batch =
    "WITH incoming AS (SELECT * FROM unnest($2::bigint[], $3::bigint[], $4::bigint[], $5::bigint[], $6::text[], "
    "$7::int[], "
    "$8::int[], $9::bigint[], $10::text[], $11::bytea[], $12::int[], $13::int[], $14::int[]) AS t(run, number, stored, "
    "monotonic, kind, source, peer, lost, note, packet, apid, service, subtype)), "
    "other AS (SELECT i.number FROM incoming i JOIN hirosco_log l ON l.log = $1 AND l.run = i.run AND l.number = "
    "i.number "
    "WHERE (l.stored, l.monotonic, l.kind, l.source, l.peer, l.lost, l.note, l.packet) IS DISTINCT FROM (i.stored, "
    "i.monotonic, i.kind, i.source, i.peer, i.lost, i.note, i.packet)), "
    "added AS (INSERT INTO hirosco_log (log, run, number, stored, monotonic, kind, source, peer, lost, note, packet, "
    "apid, "
    "service, subtype) SELECT $1, i.* FROM incoming i WHERE NOT EXISTS (SELECT 1 FROM other) ON CONFLICT DO NOTHING) "
    "SELECT (SELECT count(*) FROM other), coalesce((SELECT min(number) FROM other), 0), "
    "(SELECT count(*) FROM hirosco_log WHERE log = $1 AND run = $15::bigint AND number = $16::bigint)";
/// What of the numbers from $3 to $4 is there, gaps counted by what they have lost.
constexpr const char* count_kept =
    "SELECT coalesce(sum(CASE kind WHEN 'gap' THEN lost ELSE 1 END), 0)::bigint FROM hirosco_log WHERE log = $1 AND "
    "run = "
    "$2::bigint AND number BETWEEN $3::bigint AND $4::bigint";

std::string time_in_ns(OnboardTime time) { return std::to_string(time.time_since_epoch().count()); }
std::string time_in_ns(TimePoint time) { return std::to_string(time.time_since_epoch().count()); }

std::int64_t to_number(const char* text) {
  std::int64_t number = 0;
  std::from_chars(text, text + std::string_view{text}.size(), number);
  return number;
}

/// A PostgreSQL array as text, from what `text_of` makes of each record; all in quotes.
template <class TextOf>
std::string array_of(std::span<const LogRecord> batch, TextOf text_of) {
  std::string array{"{"};
  for (const LogRecord& record : batch) {
    if (array.size() > 1) array += ',';
    array += '"';
    for (const char letter : std::string{text_of(record)}) {
      if (letter == '"' || letter == '\\') array += '\\';
      array += letter;
    }
    array += '"';
  }
  return array += '}';
}

constexpr std::string_view hex_letters = "0123456789abcdef";

std::string octets_text(Octets octets) {
  std::string text{"\\x"};
  text.reserve(2 + 2 * octets.size());
  for (const std::byte octet : octets) {
    text += hex_letters[std::to_integer<std::size_t>(octet) >> 4];
    text += hex_letters[std::to_integer<std::size_t>(octet) & 0xFU];
  }
  return text;
}

bool take_octets_text(std::string_view text, std::vector<std::byte>& octets) {
  if (!text.starts_with("\\x") || text.size() % 2 != 0) return false;
  for (std::size_t i = 2; i < text.size(); i += 2) {
    const std::size_t high = hex_letters.find(text[i]);
    const std::size_t low = hex_letters.find(text[i + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos) return false;
    octets.push_back(static_cast<std::byte>(high << 4 | low));
  }
  return true;
}

constexpr std::size_t record_columns = 10;
constexpr const char* select_records =
    "SELECT run, number, stored, monotonic, kind, source, peer, lost, note, packet FROM hirosco_log WHERE log = $1 AND "
    "number >= $2::bigint AND stored BETWEEN $6::bigint AND $7::bigint AND ($3 = '' OR run = nullif($3, '')::bigint) "
    "AND ($4 = '' OR source = nullif($4, '')::int "
    "OR peer "
    "= nullif($4, '')::int OR apid = nullif($4, '')::int) AND ($5 = '' OR service = nullif($5, '')::int) AND ($8 = '' "
    "OR kind = $8)";

std::optional<LogRecord> record_of_row(std::span<const char* const> row) {
  const auto kind = from_text<LogKind>(row[4]);
  if (!kind) return std::nullopt;
  LogRecord record{.run = OnboardTime{Duration{to_number(row[0])}},
                   .number = static_cast<std::uint64_t>(to_number(row[1])),
                   .stored = OnboardTime{Duration{to_number(row[2])}},
                   .monotonic = TimePoint{Duration{to_number(row[3])}},
                   .kind = *kind,
                   .source = static_cast<std::uint16_t>(to_number(row[5])),
                   .peer = static_cast<std::uint16_t>(to_number(row[6])),
                   .lost = static_cast<std::uint32_t>(to_number(row[7])),
                   .note = Note{row[8]}};
  if (!take_octets_text(row[9], record.packet)) return std::nullopt;
  return record;
}

class PostgresqlDatabase final : public Database {
 public:
  PostgresqlDatabase(PostgresqlPlace place, DatabaseAccess access) : place_{std::move(place)}, access_{access} {}

 private:
  Result<> do_append(std::span<const LogRecord> batch) override;
  Result<LogPage> do_read(const LogQuery& query) override;
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "postgresql"; }
  [[nodiscard]] StoreTrouble do_trouble() const override { return trouble_; }

  Answer<void> connect();
  Answer<void> wait_for_turn();
  Answer<void> check_version();
  Answer<void> store(std::span<const LogRecord> batch);
  Answer<void> store_gap();
  Result<> heal_from(const Refusal& refusal);
  void note(StoreFault fault, const Error& error, std::string text, std::uint64_t lost = 0);

  PostgresqlPlace place_;
  DatabaseAccess access_;
  std::unique_ptr<PostgresqlSession> session_;
  /// What this object has stored: numbers, the first and the last record of them (without packets).
  std::uint64_t taken_{0};
  LogRecord first_;
  LogRecord last_;
  bool gone_{false};  ///< what was stored is not there any more, and no gap says so yet
  StoreTrouble trouble_;
};

Answer<void> PostgresqlDatabase::connect() {
  auto session = PostgresqlSession::connect(place_.connection, place_.limit);
  if (!session) return std::unexpected{std::move(session.error())};
  std::string fsync;
  // The server's own end of a statement comes after ours, so that it is we who say what happened.
  const auto patience = std::chrono::duration_cast<std::chrono::milliseconds>(2 * place_.limit).count();
  const std::vector limits{std::to_string(patience), std::to_string(patience / 4)};
  const auto ready = (*session)->ask(set_up_session, limits, 3, [&](auto row) {
    fsync = row[2];
    return true;
  });
  if (!ready) return ready;
  if (fsync == "off" && access_ == DatabaseAccess::Write)
    return std::unexpected{Refusal{{ErrorCode::NotPermitted, "nothing is durable there", 0}, "its fsync is off"}};
  session_ = std::move(*session);
  if (access_ == DatabaseAccess::Write)
    if (auto turn = wait_for_turn(); !turn) return turn;
  return check_version();
}

/// Half as long as an answer may take; then it ends who writes, and is refused, so that it comes again.
Answer<void> PostgresqlDatabase::wait_for_turn() {
  const std::vector log{place_.log};
  auto turn = session_->ask(take_turn, log);
  if (turn) return session_->ask(turn_is_taken, {});
  // A server that does not answer at all does not answer this either.
  static_cast<void>(session_->ask(end_whose_turn_it_is, log));
  return std::unexpected{
      Refusal{turn.error().error, "another session still writes this log, and is ended: " + turn.error().words}};
}

Answer<void> PostgresqlDatabase::check_version() {
  std::string version;
  const auto look = [&](auto row) {
    version = row[0];
    return true;
  };
  if (auto asked = session_->ask(version_of_table, {}, 1, look); !asked) return asked;
  if (version.empty() && access_ == DatabaseAccess::Write) {
    if (taken_ != 0) gone_ = true;
    for (const char* statement : {make_table, mark_table})
      if (auto made = session_->ask(statement, {}); !made) return made;
    return {};
  }
  if (version.empty()) return std::unexpected{Refusal{{ErrorCode::NotFound, "no such log in the server", 0}, {}}};
  if (version != version_text)
    return std::unexpected{Refusal{{ErrorCode::Mismatch, "not a log of ours, or of another version", 0}, version}};
  return {};
}

Answer<void> PostgresqlDatabase::store(std::span<const LogRecord> batch) {
  const auto number_text = [](auto member) {
    return [member](const LogRecord& record) { return std::to_string(std::invoke(member, record)); };
  };
  const auto label_text = [](auto member) {
    return [member](const LogRecord& record) { return std::to_string(std::invoke(member, label_of(record.packet))); };
  };
  const std::vector<std::string> values{
      place_.log,
      array_of(batch, [](const LogRecord& record) { return time_in_ns(record.run); }),
      array_of(batch, number_text(&LogRecord::number)),
      array_of(batch, [](const LogRecord& record) { return time_in_ns(record.stored); }),
      array_of(batch, [](const LogRecord& record) { return time_in_ns(record.monotonic); }),
      array_of(batch, [](const LogRecord& record) { return to_text(record.kind); }),
      array_of(batch, number_text(&LogRecord::source)),
      array_of(batch, number_text(&LogRecord::peer)),
      array_of(batch, number_text(&LogRecord::lost)),
      array_of(batch, [](const LogRecord& record) { return record.note.view(); }),
      array_of(batch, [](const LogRecord& record) { return octets_text(record.packet); }),
      array_of(batch, label_text(&PacketLabel::apid)),
      array_of(batch, label_text(&PacketLabel::service)),
      array_of(batch, label_text(&PacketLabel::subtype)),
      time_in_ns(last_.run),
      std::to_string(last_.number),
  };
  std::int64_t others = 0;
  std::int64_t first_other = 0;
  bool last_there = true;
  const auto stored = session_->ask(store_batch, values, 3, [&](auto row) {
    others = to_number(row[0]);
    first_other = to_number(row[1]);
    last_there = to_number(row[2]) != 0;
    return true;
  });
  if (!stored) return stored;
  if (others != 0)
    return std::unexpected{Refusal{{ErrorCode::AlreadyExists, "another record has this number", first_other}, {}}};
  if (taken_ != 0 && !last_there) gone_ = true;
  return {};
}

/// What of ours is not there any more stands as one Gap under the number of the last of it.
Answer<void> PostgresqlDatabase::store_gap() {
  std::uint64_t kept = 0;
  const std::vector<std::string> values{place_.log, time_in_ns(first_.run), std::to_string(first_.number),
                                        std::to_string(last_.number)};
  const auto counted = session_->ask(count_kept, values, 1, [&](auto row) {
    kept = static_cast<std::uint64_t>(to_number(row[0]));
    return true;
  });
  if (!counted) return counted;
  const std::uint64_t lost = taken_ - std::min(taken_, kept);
  LogRecord gap = last_;
  gap.number = kept == 0 ? first_.number : last_.number;
  gap.kind = LogKind::Gap;
  gap.source = gap.peer = 0;
  gap.lost = static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, UINT32_MAX));
  gap.note = "the log was deleted in the server with these";
  if (auto stored = store(std::span{&gap, 1}); !stored) return stored;
  gone_ = false;
  last_ = gap;
  note(
      StoreFault::Deleted, {ErrorCode::NotFound, "the log's records are gone", 0},
      fmt::format("log in the server was deleted: begun anew, {} records went with it; leave it alone in flight", lost),
      lost);
  return {};
}

Result<> PostgresqlDatabase::do_append(std::span<const LogRecord> batch) {
  if (access_ == DatabaseAccess::Read) return fail(ErrorCode::NotPermitted, "this log is open for reading only");
  if (!session_)
    if (const auto connected = connect(); !connected) return heal_from(connected.error());
  if (gone_)
    if (const auto stored = store_gap(); !stored) return heal_from(stored.error());
  if (const auto stored = store(batch); !stored) return heal_from(stored.error());
  if (gone_)
    if (const auto stored = store_gap(); !stored) return heal_from(stored.error());
  if (taken_ == 0) first_ = batch.front();
  for (const LogRecord& record : batch) taken_ += record.kind == LogKind::Gap ? record.lost : 1;
  last_ = batch.back();
  first_.packet = last_.packet = {};
  trouble_.present = false;
  return ok();
}

/// Whatever it was, the connection is given up: the next try begins with a new one, and the same batch.
Result<> PostgresqlDatabase::heal_from(const Refusal& refusal) {
  session_.reset();
  const Error& error = refusal.error;
  if (error.code == ErrorCode::AlreadyExists) return fail(error);
  const std::string why = refusal.words.empty() ? error.text : fmt::format("{}: {}", error.text, refusal.words);
  if (error.code == ErrorCode::ResourceExhausted)
    note(StoreFault::Full, error,
         fmt::format("no space for the log in the server ({}): make some, storing resumes by itself", why));
  else if (error.code == ErrorCode::SystemFailure)
    note(StoreFault::Damaged, error, fmt::format("the server of the log fails ({}): look at its disk", why));
  else if (error.code == ErrorCode::Unavailable)
    note(StoreFault::Unreachable, error,
         fmt::format("the server of the log cannot be used ({}): storing resumes by itself", why));
  else
    note(StoreFault::Unwritable, error,
         fmt::format("the log cannot be written to the server ({}): see its rights and name", why));
  return fail(ErrorCode::Unavailable, error.text, error.value);
}

/// Said once for each time that it begins.
void PostgresqlDatabase::note(StoreFault fault, const Error& error, std::string text, std::uint64_t lost) {
  if (trouble_.present && trouble_.fault == fault) return;
  trouble_ = {.count = trouble_.count + 1,
              .fault = fault,
              .present = true,
              .lost = lost,
              .error = error,
              .text = std::move(text)};
}

Result<LogPage> PostgresqlDatabase::do_read(const LogQuery& query) {
  if (query.last == 0) return LogPage{};
  // Who is to write goes on from what it reads: nobody else adds to that any more.
  if (access_ == DatabaseAccess::Write && !session_)
    if (const auto connected = connect(); !connected) {
      const auto healed = heal_from(connected.error());
      return fail(healed.error());
    }
  // A session of its own: who has enough rows leaves it.
  PostgresqlDatabase reader{place_, DatabaseAccess::Read};
  if (const auto connected = reader.connect(); !connected) return fail(connected.error().error);
  const bool oldest = query.end == LogEnd::Oldest;
  const std::string statement =
      std::string{select_records} + (oldest ? " ORDER BY run, number" : " ORDER BY run DESC, number DESC");
  const std::vector<std::string> values{place_.log,
                                        std::to_string(std::min<std::uint64_t>(query.since, INT64_MAX)),
                                        query.run ? time_in_ns(*query.run) : std::string{},
                                        query.apid ? std::to_string(*query.apid) : std::string{},
                                        query.service ? std::to_string(*query.service) : std::string{},
                                        time_in_ns(query.stored_from),
                                        time_in_ns(query.stored_to),
                                        query.kind ? std::string{to_text(*query.kind)} : std::string{}};
  LogPage page;
  const auto read = reader.session_->ask(statement, values, record_columns, [&](auto row) {
    auto record = record_of_row(row);
    if (!record) ++page.damaged;
    else if (matches(*record, query)) page.records.push_back(std::move(*record));
    return page.records.size() < query.last;
  });
  if (!read) return fail(read.error().error);
  if (!oldest) std::ranges::reverse(page.records);
  return page;
}

}  // namespace

Result<std::unique_ptr<Database>> open_postgresql(PostgresqlPlace place, DatabaseAccess access) {
  HIROSCO_TRY(Libpq::load());
  return std::make_unique<PostgresqlDatabase>(std::move(place), access);
}

}  // namespace hirosco::supervisor
