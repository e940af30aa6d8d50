// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {

/// A real PostgreSQL server in a folder of its own, reached by a UNIX socket there; of user `nobody` where the test is root's, which
/// PostgreSQL refuses.
class PostgresqlServer {
 public:
  [[nodiscard]] static bool installed();
  /// Null: no server program is installed here, or it does not begin; `why_not` says which.
  [[nodiscard]] static std::unique_ptr<PostgresqlServer> make(std::string& why_not);
  /// One for all tests of this program: the longest part of it is to make one.
  [[nodiscard]] static PostgresqlServer* shared(std::string& why_not);
  ~PostgresqlServer();
  PostgresqlServer(const PostgresqlServer&) = delete;
  PostgresqlServer& operator=(const PostgresqlServer&) = delete;

  /// For `PostgresqlPlace::connection`.
  [[nodiscard]] std::string connection() const {
    return "host=" + folder_.path().string() + " user=hirosco dbname=postgres";
  }
  /// Begins, and waits until it answers.
  [[nodiscard]] bool start(const std::string& setting = {});
  /// Every process of it at once.
  void signal(int number) const;
  void kill();
  /// Ends in order, as `systemctl stop` does.
  void stop();
  /// One statement by psql; what it printed, empty when it failed.
  [[nodiscard]] std::string sql(const std::string& statement) const;

 private:
  explicit PostgresqlServer(std::filesystem::path programs) : programs_{std::move(programs)} {}
  [[nodiscard]] pid_t spawn(std::vector<std::string> words, int output = -1) const;
  [[nodiscard]] bool run(std::vector<std::string> words) const;
  [[nodiscard]] std::vector<pid_t> processes() const;

  TestFolder folder_;
  std::filesystem::path programs_;
  pid_t server_{0};
};

}  // namespace hirosco::supervisor
