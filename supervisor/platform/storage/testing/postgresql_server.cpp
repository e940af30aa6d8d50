// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/testing/postgresql_server.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <optional>
#include <thread>

namespace hirosco::supervisor {

namespace fs = std::filesystem;

namespace {

/// Debian keeps one folder per version, and none of them in PATH.
std::optional<fs::path> programs_here() {
  std::vector<fs::path> found;
  std::error_code failed;
  for (const auto& version : fs::directory_iterator{"/usr/lib/postgresql", failed})
    if (fs::exists(version.path() / "bin/initdb", failed) && fs::exists(version.path() / "bin/psql", failed))
      found.push_back(version.path() / "bin");
  if (found.empty()) return std::nullopt;
  return std::ranges::max(found);
}

bool ended_well(pid_t child) {
  int status = 0;
  return child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

bool PostgresqlServer::installed() { return programs_here().has_value(); }

std::unique_ptr<PostgresqlServer> PostgresqlServer::make(std::string& why_not) {
  const auto programs = programs_here();
  if (!programs) {
    why_not = "no PostgreSQL server is installed here (package postgresql)";
    return nullptr;
  }
  std::unique_ptr<PostgresqlServer> server{new PostgresqlServer{*programs}};
  const fs::path& folder = server->folder_.path();
  const passwd* const nobody = ::getpwnam("nobody");
  if (::geteuid() == 0 && (nobody == nullptr || ::chown(folder.c_str(), nobody->pw_uid, nobody->pw_gid) != 0)) {
    why_not = "no user 'nobody' for the server";
    return nullptr;
  }
  const bool made = server->run({"initdb", "--no-sync", "--auth=trust", "--username=hirosco", "--no-locale",
                                 "--encoding=UTF8", "--pgdata=" + (folder / "data").string()});
  if (!made || !server->start()) {
    why_not = "the PostgreSQL server does not begin";
    return nullptr;
  }
  return server;
}

PostgresqlServer* PostgresqlServer::shared(std::string& why_not) {
  static std::string reason;
  static const std::unique_ptr<PostgresqlServer> server = make(reason);
  why_not = reason;
  return server.get();
}

PostgresqlServer::~PostgresqlServer() {
  if (server_ == 0) return;
  signal(SIGCONT);
  stop();
}

pid_t PostgresqlServer::spawn(std::vector<std::string> words, int output) const {
  words[0] = (programs_ / words[0]).string();
  std::vector<char*> texts;
  for (std::string& word : words) texts.push_back(word.data());
  texts.push_back(nullptr);
  const passwd* const nobody = ::geteuid() == 0 ? ::getpwnam("nobody") : nullptr;
  const std::string folder = folder_.path().string();
  const std::string log_file = folder + "/server.txt";
  const pid_t child = ::fork();
  if (child != 0) return child;
  const int nowhere = ::open("/dev/null", O_RDWR);
  const int log = ::open(log_file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
  ::dup2(nowhere, 0);
  ::dup2(output >= 0 ? output : log, 1);
  ::dup2(log, 2);
  if (nobody != nullptr && (::setgid(nobody->pw_gid) != 0 || ::setuid(nobody->pw_uid) != 0)) ::_exit(126);
  if (::chdir(folder.c_str()) != 0) ::_exit(126);
  ::execv(texts[0], texts.data());
  ::_exit(127);
}

bool PostgresqlServer::run(std::vector<std::string> words) const { return ended_well(spawn(std::move(words))); }

bool PostgresqlServer::start(const std::string& setting) {
  const std::string folder = folder_.path().string();
  server_ = 0;
  for (int i = 0; i < 600; ++i) {
    // Killed ones may hold its memory for a moment yet, and then it ends at once.
    if (server_ == 0 || ::waitpid(server_, nullptr, WNOHANG) == server_)
      server_ = spawn({"postgres", "-D", folder + "/data", "-k", folder, "-c", "listen_addresses=", "-c",
                       setting.empty() ? "max_connections=20" : setting});
    if (sql("SELECT 1") == "1\n") return true;
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  return false;
}

std::string PostgresqlServer::sql(const std::string& statement) const {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return {};
  const pid_t child = spawn({"psql", "-X", "-A", "-t", "-q", "-d", connection(), "-c", statement}, ends[1]);
  ::close(ends[1]);
  std::string text;
  char part[512];
  for (ssize_t got = 0; (got = ::read(ends[0], part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(got));
  ::close(ends[0]);
  return ended_well(child) ? text : std::string{};
}

std::vector<pid_t> PostgresqlServer::processes() const {
  std::vector<pid_t> all{server_};
  std::ifstream children{"/proc/" + std::to_string(server_) + "/task/" + std::to_string(server_) + "/children"};
  for (pid_t child = 0; children >> child;) all.push_back(child);
  return all;
}

void PostgresqlServer::signal(int number) const {
  for (const pid_t process : processes()) ::kill(process, number);
}

void PostgresqlServer::kill() {
  signal(SIGKILL);
  ::waitpid(server_, nullptr, 0);
  server_ = 0;
}

void PostgresqlServer::stop() {
  ::kill(server_, SIGINT);  // "fast": sessions are ended
  ::waitpid(server_, nullptr, 0);
  server_ = 0;
}

}  // namespace hirosco::supervisor
