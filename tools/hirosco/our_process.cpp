// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/our_process.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

namespace hirosco::tools {
namespace {

/// What a process runs; of one that has more rights than this one the system tells the beginning of its name only (docs/adr/0177).
[[nodiscard]] std::string program_of(int process) {
  std::error_code failed;
  const auto program = std::filesystem::read_symlink(fmt::format("/proc/{}/exe", process), failed);
  if (!failed) return program.filename().string();
  std::string name;
  std::ifstream file{fmt::format("/proc/{}/comm", process)};
  std::getline(file, name);
  return name;
}

}  // namespace

std::optional<Process> our_process(int number) {
  if (number <= 0) return std::nullopt;
  auto process = Process::adopt(number);  // before we look: nobody else gets its number behind this handle
  if (!process || !program_of(number).starts_with("hirosco")) return std::nullopt;
  const auto end = process->poll();
  if (end && *end) return std::nullopt;
  return std::move(*process);
}

std::optional<Process> our_listener(int socket) {
  ucred listener{};
  socklen_t octets = sizeof listener;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &listener, &octets) != 0) return std::nullopt;
  auto process = our_process(listener.pid);
  // Behind that: while this connection lives its number is nobody else's.
  pollfd connection{socket, 0, 0};
  if (::poll(&connection, 1, 0) != 0) return std::nullopt;
  return process;
}

}  // namespace hirosco::tools
