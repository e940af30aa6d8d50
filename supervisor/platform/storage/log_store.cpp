// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/log_store.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <utility>

namespace hirosco::supervisor {

namespace fs = std::filesystem;

namespace {

Result<std::unique_ptr<Database>> open_with_folder(DatabaseStrategy strategy, const fs::path& path) {
  std::error_code failed;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), failed);
  return open_database(strategy, path);
}

StoreFault fault_of(const Error& error) {
  switch (error.code) {
    case ErrorCode::Unavailable: return StoreFault::Locked;
    case ErrorCode::ResourceExhausted: return StoreFault::Full;
    case ErrorCode::NotPermitted:
    case ErrorCode::NotFound: return StoreFault::Unwritable;
    default: return StoreFault::Damaged;
  }
}

std::uint64_t covered_by(const LogRecord& record) { return record.kind == LogKind::Gap ? record.lost : 1; }

}  // namespace

LogStore::LogStore(DatabaseStrategy strategy, fs::path log, const LogLimits& limits)
    : LogStore{strategy, std::move(log), limits,
               [strategy](const fs::path& file) { return open_with_folder(strategy, file); }} {}

LogStore::LogStore(DatabaseStrategy strategy, fs::path log, const LogLimits& limits, Open open)
    : strategy_{strategy}, log_{std::move(log)}, limits_{limits}, open_{std::move(open)} {}

LogStore::Identity LogStore::identity_of(const fs::path& path) {
  struct stat found{};
  if (::stat(path.c_str(), &found) != 0) return {};
  return {static_cast<std::uint64_t>(found.st_dev), static_cast<std::uint64_t>(found.st_ino),
          static_cast<std::uint64_t>(found.st_size)};
}

fs::path LogStore::ahead_path() const { return fs::path{piece_} += "-wal"; }

/// Another strategy's piece is never gone on in: who reads tells a piece's strategy by its name.
void LogStore::choose_piece() {
  const auto pieces = pieces_of(log_);
  if (pieces.empty()) return go_to(1);
  const LogPiece& newest = pieces.back();
  go_to(newest.strategy == strategy_ ? newest.number : newest.number + 1);
}

void LogStore::go_to(int number) {
  store_.reset();
  number_ = number;
  piece_ = piece_path(log_, strategy_, number);
  file_ = ahead_ = {};
  ours_ = stored_ = false;
  born_.reset();
}

/// The name means no file any more, or another one: what is written now nobody will find. A file of ours never becomes shorter.
LogStore::Look LogStore::look() const {
  if (file_.none()) return Look::Whole;
  const Identity now = identity_of(piece_);
  if (!now.same_file(file_)) return Look::Gone;
  if (!ahead_.none() && !identity_of(ahead_path()).same_file(ahead_)) return Look::Gone;
  return now.octets < file_.octets || (!ahead_.none() && identity_of(ahead_path()).octets < ahead_.octets)
             ? Look::Cut
             : Look::Whole;
}

/// What cannot be found of this any more. A cut file is read for it: it keeps its beginning, or nothing.
void LogStore::count_lost(Written& written, bool cut) const {
  if (!written.place.there()) {
    written.lost = written.count;
    written.first_lost = written.first.number;
    return;
  }
  written.lost = 0;
  if (!cut) return;
  std::uint64_t kept = 0;
  std::uint64_t next = written.first.number;
  const auto count = [&](const LogRecord& record) {
    if (record.number >= written.first.number) kept += covered_by(record);
    next = std::max(next, record.number + 1);
    return std::string{};
  };
  auto rest = open_database(strategy_, written.place.path, DatabaseAccess::Read);
  if (!rest || !(*rest)->read({.text = "of no record", .words = count, .run = written.first.run})) kept = 0;
  written.lost = written.count - std::min(written.count, kept);
  written.first_lost = kept != 0 ? next : written.first.number;
}

/// Begins the next piece when something has happened to the present one; what went with it is counted where it was written, and
/// stands as a Gap in the next. False: all is as it was left.
bool LogStore::begin_anew() {
  const Look seen = look();
  if (seen == Look::Whole) return false;
  const std::string name = piece_.filename().string();
  store_.reset();  // where the file itself is still there, closing has put what it had ahead into it
  std::uint64_t lost = 0;
  gap_.reset();
  for (Written& each : written_) {
    if (each.told.there()) continue;
    each.told = {};
    count_lost(each, seen == Look::Cut && each.place.path == piece_);
    if (each.lost == 0) continue;
    lost += each.lost;
    if (gap_ && gap_->number < each.first_lost) continue;
    gap_ = each.first;
    gap_->number = each.first_lost;
  }
  if (gap_) {
    gap_->kind = LogKind::Gap;
    gap_->source = gap_->peer = 0;
    gap_->lost = static_cast<std::uint32_t>(std::min<std::uint64_t>(lost, UINT32_MAX));
    gap_->note = seen == Look::Cut ? "the log was cut by these" : "the log was deleted or moved away with these";
  }
  note(StoreFault::Deleted, {ErrorCode::NotFound, "the log's file is gone", 0},
       fmt::format("log {} was {}: begun anew, {} records went with it; leave it alone in flight", name,
                   seen == Look::Cut ? "cut" : "deleted or moved", lost),
       lost);
  const auto pieces = pieces_of(log_);
  go_to(pieces.empty() ? 1 : pieces.back().number + 1);
  return true;
}

bool LogStore::due(OnboardTime now) const {
  if (limits_.rotate_octets != 0 && piece_octets(piece_) >= limits_.rotate_octets) return true;
  return limits_.rotate_age > Duration{0} && born_ && now - *born_ >= limits_.rotate_age;
}

void LogStore::rotate() {
  go_to(number_ + 1);
  ++turnover_.begun;
}

/// Before the next piece is begun, so that there is never more than what was declared.
void LogStore::remove_oldest() {
  if (limits_.keep_octets == 0) return;
  const auto pieces = pieces_of(log_);
  std::uint64_t octets = limits_.rotate_octets;
  for (const LogPiece& piece : pieces) octets += piece_octets(piece.path);
  for (const LogPiece& piece : pieces) {
    if (octets <= limits_.keep_octets) return;
    const std::uint64_t its = piece_octets(piece.path);
    octets -= std::min(octets, its);
    remove_piece(piece.path);
    ++turnover_.removed_pieces;
    turnover_.removed_octets += its;
    turnover_.newest_removed = piece.path.filename().string();
    for (const Written& each : written_)
      if (each.place.path == piece.path) turnover_.removed_records += each.count;
    std::erase_if(written_, [&](const Written& each) { return each.place.path == piece.path; });
  }
}

Result<> LogStore::open_and_store(std::span<const LogRecord> batch) {
  if (!store_) {
    // An empty one is what a stop in mid-opening has left.
    const bool fresh = identity_of(piece_).octets == 0;
    if (fresh && !ours_) remove_oldest();
    ours_ = ours_ || fresh;
    HIROSCO_TRY_LET(store_, open_(piece_));
    file_ = identity_of(piece_);
    ahead_ = {};
    learn_age();
  }
  if (gap_) HIROSCO_TRY(store_gap());
  HIROSCO_TRY(store_->append(batch));
  // Another file behind the name shows at the next look.
  if (const Identity now = identity_of(piece_); now.same_file(file_)) file_ = now;
  if (const Identity now = identity_of(ahead_path()); ahead_.none() || now.same_file(ahead_)) ahead_ = now;
  return ok();
}

Result<> LogStore::store_gap() {
  HIROSCO_TRY(store_->append(std::span{&*gap_, 1}));
  stored_ = true;
  gap_.reset();
  for (Written& each : written_)
    if (each.lost != 0 && each.told.file.none()) each.told = {piece_, file_};
  return ok();
}

/// A piece that an earlier flight has begun is as old as that says.
void LogStore::learn_age() {
  if (limits_.rotate_age == Duration{0} || born_ || ours_) return;
  const auto oldest = store_->read({.last = 1, .end = LogEnd::Oldest});
  if (oldest && !oldest->records.empty()) born_ = oldest->records.front().stored;
}

void LogStore::took(std::span<const LogRecord> batch) {
  stored_ = true;
  if (!born_) born_ = batch.front().stored;
  if (written_.empty() || written_.back().place.path != piece_ || !written_.back().place.file.same_file(file_)) {
    if (written_.size() == most_written) written_.erase(written_.begin());
    written_.push_back({.place = {piece_, file_}, .first = batch.front()});
    written_.back().first.packet = {};
  }
  for (const LogRecord& record : batch) written_.back().count += covered_by(record);
}

Result<> LogStore::do_append(std::span<const LogRecord> batch) {
  if (number_ == 0) choose_piece();
  if (!begin_anew() && due(batch.front().stored)) rotate();
  Result<> outcome = open_and_store(batch);
  if (outcome && begin_anew()) {
    // Under this very batch: it is durable in nothing that has a name.
    outcome = open_and_store(batch);
    if (outcome && look() != Look::Whole) return fail(ErrorCode::Unavailable, "the log is deleted again and again");
  }
  if (!outcome) {
    heal_from(outcome.error());
    return fail(ErrorCode::Unavailable, outcome.error().text, outcome.error().value);
  }
  took(batch);
  trouble_.present = false;
  return ok();
}

void LogStore::heal_from(const Error& error) {
  const StoreFault fault = fault_of(error);
  const std::string name = piece_.filename().string();
  if (fault != StoreFault::Locked) store_.reset();  // it stores nothing more; opening again begins where it was
  switch (fault) {
    case StoreFault::Locked:
      return note(fault, error, fmt::format("log {} is locked by another program: end that one", name));
    case StoreFault::Full:
      return note(fault, error, fmt::format("no space for log {}: make some, storing resumes by itself", name));
    case StoreFault::Unwritable:
      return note(fault, error, fmt::format("log {} cannot be written: see its folder, owner and rights", name));
    case StoreFault::Deleted:
    case StoreFault::Unreachable:
    case StoreFault::Damaged: break;
  }
  leave_piece();
  if (error.code == ErrorCode::Mismatch)
    return note(fault, error,
                fmt::format("log {} is left alone ({}, {}): goes on in {}; read the first with what wrote it", name,
                            error.text, error.value, piece_.filename().string()));
  note(fault, error,
       fmt::format("log {} failed ({}, {}): goes on in {}; look at the disk", name, error.text, error.value,
                   piece_.filename().string()));
}

/// After a failed fsync nobody knows what the file holds: it is left as it is, and what was not acknowledged is written
/// to the next one. One that was begun by this store and never took anything is not left behind, but for the first.
void LogStore::leave_piece() {
  if (ours_ && !stored_ && number_ != 1) {
    remove_piece(piece_);
    return go_to(number_);
  }
  const auto pieces = pieces_of(log_);
  go_to(std::max(number_, pieces.empty() ? 0 : pieces.back().number) + 1);
}

/// Said once for each time that it begins.
void LogStore::note(StoreFault fault, const Error& error, std::string text, std::uint64_t lost) {
  if (trouble_.present && trouble_.fault == fault) return;
  trouble_ = {.count = trouble_.count + 1,
              .fault = fault,
              .present = true,
              .lost = lost,
              .error = error,
              .text = std::move(text)};
}

}  // namespace hirosco::supervisor
