// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "simulation/devices/module.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/instance.hpp"

namespace hirosco::tools {
namespace {

constexpr int answer_limit_ms = 2000;
/// A device's control socket closes on whoever sends more.
constexpr std::size_t longest_line = 255;
constexpr const char* lines_of_every_device =
    "every device takes: unplug, plug, silent, stall MS, freeze MS, delay MS, corrupt FRAMES, heal, truth\n";

/// What it takes besides, as its module tells; nothing where that is not here.
void print_lines_of(const descriptor::Mission& mission, const std::string& name) {
  fmt::print(stderr, "{}", lines_of_every_device);
  const auto device = std::ranges::find(mission.devices, name, &descriptor::SimulatedDevice::name);
  if (device == mission.devices.end()) return;
  const auto module = simulation::load_device(device->executable);
  if (!module) return;
  for (const auto& fault : (*module)->faults) fmt::print(stderr, "{} besides: {} ({})\n", name, fault.line, fault.text);
}

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
  const auto found = find_flight("fault", options.mission, options.instance);
  if (!found) return found.error();
  const descriptor::Mission& mission = found->mission;
  std::string line;
  for (const std::string& word : options.words) line += (line.empty() ? "" : " ") + word;
  if (line.size() > longest_line || line.find('\n') != std::string::npos) {
    fmt::print(stderr, "hirosco fault: one line of at most {} characters, not {}\n", longest_line, line.size());
    return exit_usage;
  }
  const auto answer =
      ask((found->flight ? found->flight->folder : runtime_folder(mission.name)) / options.device, line);
  if (!answer) {
    fmt::print(stderr, "hirosco fault: no simulated device '{}' answers; does {} run? Devices:", options.device,
               found->flight ? found->flight->instance : mission.name);
    for (const auto& device : mission.devices) fmt::print(stderr, " {}", device.name);
    fmt::print(stderr, "\n");
    return exit_environment;
  }
  if (answer->empty()) {
    fmt::print(stderr, "hirosco fault: '{}' closed without an answer\n", options.device);
    return exit_finding;
  }
  fmt::print("{}\n", *answer);
  if (answer->find("unknown fault") != std::string::npos) print_lines_of(mission, options.device);
  return answer->starts_with("ok") ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
