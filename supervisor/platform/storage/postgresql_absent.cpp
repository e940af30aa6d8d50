// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/postgresql_database.hpp"

/// Stands in where libpq-dev was missing at configure.
namespace hirosco::supervisor {

Result<std::unique_ptr<Database>> open_postgresql(PostgresqlPlace, DatabaseAccess) {
  return fail(ErrorCode::NotFound, "this HIROSCO is built without PostgreSQL");
}

}  // namespace hirosco::supervisor
