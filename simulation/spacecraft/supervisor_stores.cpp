// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/supervisor_stores.hpp"

#include <span>
#include <string_view>

namespace hirosco::simulation {
namespace {

/// Hands the records of the supervisor's log on to a database that somebody else keeps.
class BorrowedDatabase final : public supervisor::Database {
 public:
  explicit BorrowedDatabase(supervisor::Database& target) : target_{target} {}

 private:
  Result<> do_append(std::span<const supervisor::LogRecord> batch) override { return target_.append(batch); }
  Result<supervisor::LogPage> do_read(const supervisor::LogQuery& query) override { return target_.read(query); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return target_.strategy(); }
  supervisor::Database& target_;
};

}  // namespace

SupervisorStores::SupervisorStores(const Parts& parts)
    : open_database_{parts.open_database}, values_{parts.values}, readings_{parts.files} {
  log_ = parts.make_log ? parts.make_log(parts.clock)
                        : std::make_unique<supervisor::DirectPacketLog>(parts.clock,
                                                                        std::make_unique<BorrowedDatabase>(parts.log));
  if (parts.make_log_readings)
    make_log_readings_ = [make = parts.make_log_readings, &clock = parts.clock] { return make(clock); };
  else if (!parts.make_log)
    make_log_readings_ = [&log = parts.log] {
      return std::make_unique<supervisor::DirectLogReadings>(
          [&log](const supervisor::LogQuery& query) { return log.read(query); });
    };
  if (!open_database_)
    open_database_ = [](supervisor::DatabaseStrategy) -> std::unique_ptr<supervisor::Database> {
      return std::make_unique<supervisor::MemoryDatabase>();
    };
}

supervisor::LogReadings* SupervisorStores::begin_log_readings() {
  log_readings_ = make_log_readings_ ? make_log_readings_() : nullptr;
  return log_readings_.get();
}

}  // namespace hirosco::simulation
