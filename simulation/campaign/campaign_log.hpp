// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "supervisor/platform/storage/log_readings.hpp"
#include "supervisor/platform/storage/packet_log.hpp"

/// The supervisor's log with the faults that a disk has.
namespace hirosco::campaign {

enum class DiskFault : std::uint8_t { None, Failing, Full, Deleted };

/// The disk, as it was before and after everything that happened to it.
struct Disk {
  std::vector<supervisor::LogRecord> records;
  std::vector<supervisor::LogRecord> deleted{};  ///< what nobody can read any more, for who judges the flight
  DiskFault fault{DiskFault::None};
  Duration delay{};                  ///< until a record is durable; Duration::max(): it stands still
  /// For planted defects: false keeps a record from the disk.
  std::function<bool(const supervisor::LogRecord&)> keeps{};
};

/// Takes `fault` as it is at each append. `disk` outlives it.
[[nodiscard]] std::unique_ptr<supervisor::Database> database_on(Disk& disk);

/// Stores in order of arrival, durable after the disk's delay.
[[nodiscard]] std::unique_ptr<supervisor::PacketLog> log_on(Disk& disk, const Clock& clock);

/// Reads a page after the disk's delay, from what stands there then; a failing disk gives none.
[[nodiscard]] std::unique_ptr<supervisor::LogReadings> readings_on(const Disk& disk, const Clock& clock);

}  // namespace hirosco::campaign
