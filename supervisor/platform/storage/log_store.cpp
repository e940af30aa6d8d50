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

constexpr int most_segments = 1000;

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

}  // namespace

fs::path segment_of(const fs::path& path, int number) {
  if (number <= 1) return path;
  fs::path name = path.stem();
  name += fmt::format(".{}", number);
  name += path.extension();
  return path.parent_path() / name;
}

std::vector<fs::path> segments_of(const fs::path& path) {
  std::vector<fs::path> segments{path};
  std::error_code failed;
  for (int number = 2; number <= most_segments; ++number) {
    fs::path segment = segment_of(path, number);
    if (!fs::exists(segment, failed)) break;
    segments.push_back(std::move(segment));
  }
  return segments;
}

Result<LogPage> read_segments(DatabaseStrategy strategy, const fs::path& path, const LogQuery& query) {
  const auto segments = segments_of(path);
  LogPage all;
  for (const fs::path& segment : segments) {
    auto database = open_database(strategy, segment, DatabaseAccess::Read);
    Result<LogPage> page = database ? (*database)->read(query) : fail(database.error());
    // A segment that cannot be read is why there is a next one; alone it is all that is asked for.
    if (!page && segments.size() == 1) return page;
    if (!page) {
      ++all.damaged;
      continue;
    }
    all.damaged += page->damaged;
    std::ranges::move(page->records, std::back_inserter(all.records));
  }
  if (segments.size() > 1) {
    const auto name = [](const LogRecord& record) { return std::pair{record.run, record.number}; };
    std::ranges::stable_sort(all.records, {}, name);
    const auto twice = std::ranges::unique(all.records, {}, name);
    all.records.erase(twice.begin(), twice.end());
    if (all.records.size() > query.last)
      all.records.erase(all.records.begin(), all.records.end() - static_cast<std::ptrdiff_t>(query.last));
  }
  return all;
}

LogStore::LogStore(DatabaseStrategy strategy, fs::path path)
    : LogStore{strategy, std::move(path),
               [strategy](const fs::path& file) { return open_with_folder(strategy, file); }} {}

LogStore::LogStore(DatabaseStrategy strategy, fs::path path, Open open)
    : strategy_{strategy}, path_{std::move(path)}, open_{std::move(open)}, segment_path_{path_} {}

LogStore::Identity LogStore::identity_of(const fs::path& path) {
  struct stat found{};
  if (::stat(path.c_str(), &found) != 0) return {};
  return {static_cast<std::uint64_t>(found.st_dev), static_cast<std::uint64_t>(found.st_ino)};
}

fs::path LogStore::beside(const char* suffix) const {
  fs::path path = segment_path_;
  path += suffix;
  return path;
}

/// The name means no file any more, or another one: what is written now nobody will find.
bool LogStore::gone() const {
  if (!store_ || file_ == Identity{}) return false;
  if (identity_of(segment_path_) != file_) return true;
  return ahead_ != Identity{} && identity_of(beside("-wal")) != ahead_;
}

void LogStore::forget_gone() {
  store_.reset();
  // Where the file itself is still there, closing has put what it had ahead into it.
  const bool all = identity_of(segment_path_) != file_;
  if (all && taken_ != 0) {
    gap_ = first_;
    gap_->kind = LogKind::Gap;
    gap_->source = gap_->peer = 0;
    gap_->packet.clear();
    gap_->lost = static_cast<std::uint32_t>(std::min<std::uint64_t>(taken_, UINT32_MAX));
    gap_->note = "the log was deleted or moved away with these";
  }
  note(StoreFault::Deleted, {ErrorCode::NotFound, "the log's file is gone", 0},
       fmt::format("log {} was deleted or moved: begun anew, {} records went with it; leave it alone in flight",
                   segment_path_.filename().string(), all ? taken_ : 0));
  taken_ = 0;
}

Result<> LogStore::open_and_store(std::span<const LogRecord> batch) {
  if (!store_) {
    HIROSCO_TRY_LET(store_, open_(segment_path_));
    taken_ = 0;
    file_ = identity_of(segment_path_);
    ahead_ = {};
  }
  if (gap_) {
    HIROSCO_TRY(store_->append(std::span{&*gap_, 1}));
    took(std::span{&*gap_, 1});
    gap_.reset();
  }
  HIROSCO_TRY(store_->append(batch));
  if (ahead_ == Identity{}) ahead_ = identity_of(beside("-wal"));
  return ok();
}

void LogStore::took(std::span<const LogRecord> batch) {
  if (taken_ == 0) first_ = batch.front();
  for (const LogRecord& record : batch) taken_ += record.kind == LogKind::Gap ? record.lost : 1;
}

Result<> LogStore::do_append(std::span<const LogRecord> batch) {
  if (gone()) forget_gone();
  Result<> outcome = open_and_store(batch);
  if (outcome && gone()) {
    // Under this very batch: it is durable in nothing that has a name.
    forget_gone();
    outcome = open_and_store(batch);
    if (outcome && gone()) return fail(ErrorCode::Unavailable, "the log is deleted again and again");
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
  const std::string name = segment_path_.filename().string();
  if (fault != StoreFault::Locked) store_.reset();  // it stores nothing more; opening again begins where it was
  switch (fault) {
    case StoreFault::Locked:
      return note(fault, error, fmt::format("log {} is locked by another program: end that one", name));
    case StoreFault::Full:
      return note(fault, error, fmt::format("no space for log {}: make some, storing resumes by itself", name));
    case StoreFault::Unwritable:
      return note(fault, error, fmt::format("log {} cannot be written: see its folder, owner and rights", name));
    case StoreFault::Deleted:
    case StoreFault::Damaged: break;
  }
  leave_segment();
  note(fault, error,
       fmt::format("log {} failed ({}, {}): goes on in {}; look at the disk", name, error.text, error.value,
                   segment_path_.filename().string()));
}

/// After a failed fsync nobody knows what the file holds: it is left as it is, and what was not acknowledged is written
/// to the next one. A segment that never took anything is not left behind.
void LogStore::leave_segment() {
  const int number = static_cast<int>(segments_of(path_).size());
  if (taken_ == 0 && segment_path_ != path_) {
    std::error_code failed;
    for (const char* suffix : {"", "-wal", "-shm"}) fs::remove(beside(suffix), failed);
    return;
  }
  segment_path_ = segment_of(path_, number + 1);
  taken_ = 0;
}

/// Said once for each time that it begins.
void LogStore::note(StoreFault fault, const Error& error, std::string text) {
  if (trouble_.present && trouble_.fault == fault) return;
  trouble_ = {.count = trouble_.count + 1, .fault = fault, .present = true, .error = error, .text = std::move(text)};
}

}  // namespace hirosco::supervisor
