// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "hirosco/descriptor/read/read.hpp"
#include "supervisor/platform/launch/descriptor_readings.hpp"
#include "supervisor/platform/storage/database.hpp"
#include "supervisor/platform/storage/log_readings.hpp"
#include "supervisor/platform/storage/packet_log.hpp"
#include "supervisor/platform/storage/value_store.hpp"

namespace hirosco::simulation {

/// What the supervisors of a flight store on and read from, one after the other: packet log, persistent values, files.
class SupervisorStores {
 public:
  struct Parts {
    const Clock& clock;
    supervisor::Database& log;
    /// In place of a log that stores at once in `log`; empty: that one.
    const std::function<std::unique_ptr<supervisor::PacketLog>(const Clock&)>& make_log;
    /// Who reads a log that was made so; empty: nobody.
    const std::function<std::unique_ptr<supervisor::LogReadings>(const Clock&)>& make_log_readings;
    supervisor::DatabaseOpener open_database;  ///< empty: one in memory
    supervisor::ValueStore* values;  ///< null: of this flight alone
    descriptor::FileSource files;
  };
  explicit SupervisorStores(const Parts& parts);
  SupervisorStores(const SupervisorStores&) = delete;
  SupervisorStores& operator=(const SupervisorStores&) = delete;

  [[nodiscard]] supervisor::PacketLog& log() noexcept { return *log_; }
  /// Of one more supervisor: for what the one before had asked of the log nobody waits. Null: its log is not read.
  [[nodiscard]] supervisor::LogReadings* begin_log_readings();
  /// For SET_DATABASE.
  [[nodiscard]] const supervisor::DatabaseOpener& open_database() const noexcept { return open_database_; }
  /// Of persistent parameters.
  [[nodiscard]] supervisor::ValueStore& values() noexcept { return values_ != nullptr ? *values_ : own_values_; }
  /// Of descriptors that are read again.
  [[nodiscard]] supervisor::DescriptorReadings& readings() noexcept { return readings_; }

 private:
  std::unique_ptr<supervisor::PacketLog> log_;
  std::function<std::unique_ptr<supervisor::LogReadings>()> make_log_readings_;  ///< empty: it is not read
  std::unique_ptr<supervisor::LogReadings> log_readings_;
  supervisor::DatabaseOpener open_database_;
  supervisor::ValueStore* values_;
  supervisor::MemoryValueDisk forgotten_;
  supervisor::DirectValueStore own_values_{forgotten_, "values"};
  supervisor::DirectReadings readings_;
};

}  // namespace hirosco::simulation
