// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "supervisor/platform/storage/database.hpp"

namespace hirosco::supervisor {

/// Where a server keeps the log.
struct PostgresqlPlace {
  /// As libpq takes it: `service=hirosco`, `host=/run/postgresql dbname=hirosco`. A password comes from libpq's own places
  /// (passfile, service file, environment), never from here.
  std::string connection;
  std::string log;  ///< which log of several in one database: `log_name` of its path (log_pieces.hpp)
  /// How long connecting, or one answer, may take before the connection is cut and the log asks again.
  Duration limit{std::chrono::seconds{2}};
};

/// The log in a PostgreSQL server (adr 0083), table `hirosco_log`: a batch is one statement, durable when `append` returns. It
/// connects in the thread that writes, and again after whatever happened; a server that is stopped, frozen, full or gone is
/// answered as Unavailable, and the same batch comes again: what a cut connection had stored after all is not stored twice, by the key
/// (log, run, number). Records that were deleted under it stand as one Gap.
/// NotFound: built without libpq, or it is not installed here. Thread: one, which may wait for `limit` at each call.
[[nodiscard]] Result<std::unique_ptr<Database>> open_postgresql(PostgresqlPlace place,
                                                                DatabaseAccess access = DatabaseAccess::Write);

}  // namespace hirosco::supervisor
