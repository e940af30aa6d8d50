// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {
namespace {

constexpr int answer_limit_ms = 2000;

/// Asks a device's control socket one line; empty when nobody answers.
[[nodiscard]] std::optional<std::string> ask(const std::filesystem::path& socket_path, const std::string& line) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = socket_path.string();
  if (path.size() >= sizeof address.sun_path) return std::nullopt;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  const FileDescriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  if (!socket || ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return std::nullopt;
  const std::string request = line + "\n";
  if (::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL) < 0) return std::nullopt;
  std::string answer;
  for (;;) {
    pollfd wanted{socket.get(), POLLIN, 0};
    if (::poll(&wanted, 1, answer_limit_ms) <= 0) return std::nullopt;
    std::array<char, 4096> buffer;
    const auto got = ::recv(socket.get(), buffer.data(), buffer.size(), 0);
    if (got <= 0) break;
    answer.append(buffer.data(), static_cast<std::size_t>(got));
    if (answer.find('\n') != std::string::npos) break;
  }
  return answer.substr(0, answer.find('\n'));
}

}  // namespace

int fault(const FaultOptions& options) {
  const auto mission = load_mission(options.mission);
  if (!mission) return exit_finding;
  std::string line;
  for (const std::string& word : options.words) line += (line.empty() ? "" : " ") + word;
  const auto answer = ask(runtime_folder(*mission) / options.device, line);
  if (!answer) {
    fmt::print(stderr, "hirosco fault: no simulated device '{}' answers; does {} run? Devices:", options.device,
               mission->name);
    for (const auto& device : mission->devices) fmt::print(stderr, " {}", device.name);
    fmt::print(stderr, "\n");
    return exit_environment;
  }
  fmt::print("{}\n", *answer);
  return answer->starts_with("ok") ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
