// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/log_readings.hpp"

#include <memory>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "supervisor/platform/storage/log_pieces.hpp"
#include "supervisor/platform/storage/postgresql_database.hpp"

namespace hirosco::supervisor {

LogReader reader_of(std::filesystem::path log, std::string server) {
  return [log = std::move(log), server = std::move(server)](const LogQuery& query) {
    std::unique_ptr<Database> beside;
    bool refused = false;
    if (!server.empty()) {
      auto opened = open_postgresql({.connection = server, .log = log_name(log)}, DatabaseAccess::Read);
      if (opened) beside = std::move(*opened);
      else refused = opened.error().code != ErrorCode::NotFound;
    }
    const std::vector<Database*> all(beside ? 1 : 0, beside.get());
    auto page = read_log(log, query, all);
    if (page && refused) ++page->damaged;
    return page;
  };
}

Result<> DirectLogReadings::begin(const LogQuery& query) {
  if (newest_) return fail(ErrorCode::Unavailable, "another page of the log is being read");
  newest_ = read_(query);
  return ok();
}

Result<> ThreadedLogReadings::begin(const LogQuery& query) {
  if (reading_.valid()) return fail(ErrorCode::Unavailable, "another page of the log is being read");
  try {
    std::packaged_task<Result<LogPage>()> task{[read = read_, query] { return read(query); }};
    reading_ = task.get_future();
    std::thread{std::move(task)}.detach();
  } catch (const std::system_error&) {
    reading_ = {};
    return fail(ErrorCode::ResourceExhausted, "no thread is left to read the log");
  }
  return ok();
}

std::optional<Result<LogPage>> ThreadedLogReadings::outcome() {
  if (!reading_.valid() || reading_.wait_for(std::chrono::seconds{0}) != std::future_status::ready) return std::nullopt;
  try {
    return reading_.get();
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::ResourceExhausted, "no memory is left to read the log");
  }
}

}  // namespace hirosco::supervisor
