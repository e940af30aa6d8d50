// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "hirosco/utilities/os/file_descriptor.hpp"
#include "simulation/devices/module.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/instance.hpp"

namespace hirosco::tools {
namespace {

constexpr int answer_limit_ms = 2000;
/// A device's control socket closes on whoever sends more.
constexpr std::size_t longest_line = 255;

/// What it takes: what every device does, and besides what its module tells, if that is here.
void print_lines_of(const descriptor::Mission& mission, const std::string& name, std::FILE* to) {
  const auto print = [&](std::span<const simulation::FaultLine> lines) {
    for (const auto& fault : lines) fmt::print(to, "  {:<28} {}\n", fault.line, fault.text);
  };
  fmt::print(to, "{} takes:\n", name);
  print(simulation::SimulatedDevice::common_fault_lines);
  const auto device = std::ranges::find(mission.devices, name, &descriptor::SimulatedDevice::name);
  if (device == mission.devices.end()) return;
  if (const auto module = simulation::load_device(device->executable)) print((*module)->faults);
}

/// First words of those lines.
[[nodiscard]] std::vector<std::string> first_words(const descriptor::Mission& mission, const std::string& name) {
  std::vector<std::string> words;
  const auto add = [&](std::span<const simulation::FaultLine> lines) {
    for (const auto& fault : lines) {
      const std::string line{fault.line};
      words.push_back(line.substr(0, line.find(' ')));
    }
  };
  add(simulation::SimulatedDevice::common_fault_lines);
  const auto device = std::ranges::find(mission.devices, name, &descriptor::SimulatedDevice::name);
  if (device != mission.devices.end())
    if (const auto module = simulation::load_device(device->executable)) add((*module)->faults);
  return words;
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
  std::vector<std::string> devices;
  for (const auto& device : mission.devices) devices.push_back(device.name);
  if (options.device.empty()) {
    for (const std::string& device : devices) print_lines_of(mission, device, stdout);
    if (devices.empty()) fmt::print("mission {} has no simulated device\n", mission.name);
    return exit_ok;
  }
  if (std::ranges::find(devices, options.device) == devices.end()) {
    fmt::print(stderr, "hirosco fault: mission {} has no simulated device '{}'{}; there are: {}\n", mission.name,
               options.device, did_you_mean(options.device, devices), fmt::join(devices, ", "));
    return exit_usage;
  }
  if (options.words.empty()) {
    print_lines_of(mission, options.device, stdout);
    return exit_ok;
  }
  std::string line;
  for (const std::string& word : options.words) line += (line.empty() ? "" : " ") + word;
  if (line.size() > longest_line || line.find('\n') != std::string::npos) {
    fmt::print(stderr, "hirosco fault: one line of at most {} characters, not {}\n", longest_line, line.size());
    return exit_usage;
  }
  const auto answer =
      ask((found->flight ? found->flight->folder : runtime_folder(mission.name)) / options.device, line);
  if (!answer) {
    if (found->flight)
      fmt::print(stderr, "hirosco fault: simulated device '{}' does not answer; does {} run?\n", options.device,
                 found->flight->instance);
    else
      fmt::print(stderr, "hirosco fault: {} does not fly here (hirosco run {}): nobody plays '{}'\n", mission.name,
                 options.mission.empty() ? meant_mission() : options.mission, options.device);
    return exit_environment;
  }
  if (answer->empty()) {
    fmt::print(stderr, "hirosco fault: '{}' closed without an answer\n", options.device);
    return exit_finding;
  }
  fmt::print("{}\n", *answer);
  if (answer->find("unknown fault") != std::string::npos) {
    fmt::print(stderr, "hirosco fault: '{}'{}\n", line,
               did_you_mean(options.words.front(), first_words(mission, options.device)));
    print_lines_of(mission, options.device, stderr);
  }
  return answer->starts_with("ok") ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
