// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/subsystem_sandbox.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/device/device_memory_name.hpp"
#include "hirosco/data_transfer/device/device_network.hpp"
#include "hirosco/data_transfer/device/system_flow_factory.hpp"
#include "hirosco/descriptor/model/setting_files.hpp"
#include "hirosco/utilities/os/installation.hpp"

namespace hirosco::supervisor {
namespace {

/// Where a file that a mission names really is.
[[nodiscard]] std::filesystem::path place_of(const std::filesystem::path& file) {
  const std::string text = file.string();
  if (!text.starts_with(shipped_prefix)) return std::filesystem::absolute(file);
  return find_shipped(std::string_view{text}.substr(shipped_prefix.size()));
}

void add_once(std::string place, std::vector<std::string>& places) {
  if (std::ranges::find(places, place) == places.end()) places.push_back(std::move(place));
}

void add_file(const std::filesystem::path& file, Sandbox& sandbox) {
  sandbox.readable.push_back(place_of(file).string());
}

/// What is reached by it, and what a socket of the kind reaches.
void add_internet_address(const descriptor::Endnode& endnode, SandboxSockets& sockets) {
  const auto address = read_device_address(endnode.address);
  // By a datagram it is found out from where the system would speak to a device in a network.
  if (endnode.transfer == Transfer::Udp || (address && !address->loopback())) sockets.datagrams = true;
  // And its own end is bound to an address of that network.
  if (endnode.transfer == Transfer::Tcp && address && !address->loopback()) sockets.own_port = true;
  if (endnode.transfer == Transfer::Tcp && address &&
      std::ranges::find(sockets.ports, address->port) == sockets.ports.end())
    sockets.ports.push_back(address->port);
}

void add_address(const descriptor::Endnode& endnode, Sandbox& sandbox) {
  // Queues lie in no folder that programs see, but where one is shown, that is the one whose files they are.
  if (endnode.transfer == Transfer::MessageQueue) {
    add_once("/dev/mqueue", sandbox.writable);
    sandbox.queues = true;
  }
  if (endnode.transfer == Transfer::Serial) {
    const std::string line = endnode.address.substr(0, endnode.address.rfind('@'));
    add_once(line.starts_with('/') ? line : "/dev/pts", sandbox.writable);
  }
  // A socket is made beside the other's.
  if (endnode.transfer == Transfer::Unix) {
    add_once(std::filesystem::absolute(endnode.address).parent_path().string(), sandbox.writable);
    sandbox.sockets.local = true;
  }
  if (endnode.transfer == Transfer::Udp || endnode.transfer == Transfer::Tcp)
    add_internet_address(endnode, sandbox.sockets);
}

}  // namespace

ProcessLimits limits_of(const descriptor::Resources& resources) noexcept {
  using descriptor::Resource;
  ProcessLimits limits;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  constexpr std::uint64_t octets_per_kb = 1024;
  if (const auto memory_kb = amount_of(resources.most, Resource::Memory))
    limits.memory_octets = *memory_kb * octets_per_kb;
#endif
  if (const auto descriptors = amount_of(resources.most, Resource::Descriptors)) limits.descriptors = *descriptors;
  return limits;
}

bool is_script(const std::filesystem::path& program) {
  std::ifstream file{program, std::ios::binary};
  return file.get() == '#' && file.get() == '!';
}

std::vector<std::string> memory_addresses(const descriptor::MissionSubsystem& subsystem, const std::string& instance) {
  std::vector<std::string> addresses;
  const auto add = [&](const descriptor::Endnode& endnode) {
    if (endnode.transfer == Transfer::SharedMemory) add_once(endnode.address + instance_suffix(instance), addresses);
  };
  for (const auto& configuration : subsystem.subsystem.configurations)
    for (const auto& use : configuration.devices) {
      add(use.endnode);
      for (const auto& other : use.fall_backs) add(other);
    }
  return addresses;
}

Sandbox sandbox_of(const descriptor::MissionSubsystem& subsystem, const std::filesystem::path& program,
                   const std::string& instance) {
  Sandbox sandbox;
  for (const char* library : {"/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/lib32"}) {
    sandbox.executable.emplace_back(library);  // the loader stands there, too
  }
  for (const char* file : {"/etc/ld.so.cache", "/etc/ld.so.preload", "/etc/localtime", "/usr/share/zoneinfo",
                           "/dev/urandom", "/sys/devices/system/cpu"})
    sandbox.readable.emplace_back(file);
  if (!program.empty()) sandbox.executable.push_back(std::filesystem::absolute(program).string());
  add_file(subsystem.subsystem.file, sandbox);
  for (const auto& commanded : subsystem.subsystem.commands)
    if (!commanded.file.empty()) add_file(commanded.file, sandbox);
  for (const auto& heard : subsystem.subsystem.subscribes)
    if (!heard.file.empty()) add_file(heard.file, sandbox);
  for (const auto& script : subsystem.subsystem.scripts)
    add_file(descriptor::file_of(subsystem.subsystem, script.file), sandbox);
  for (const auto& brought : subsystem.brought) add_file(brought, sandbox);
  sandbox.writable.emplace_back("/dev/null");
  sandbox.sockets.datagrams = subsystem.carries_ground || subsystem.links_by_udp;
  sandbox.sockets.streams = subsystem.carries_ground;
  for (const auto& configuration : subsystem.subsystem.configurations)
    for (const auto& use : configuration.devices) {
      for (const auto& setting : use.settings)
        if (descriptor::names_file(setting)) add_file(descriptor::file_of(subsystem.subsystem, setting.value), sandbox);
      add_address(use.endnode, sandbox);
      for (const auto& other : use.fall_backs) add_address(other, sandbox);
    }
  for (const std::string& address : memory_addresses(subsystem, instance))
    add_once(device_memory_folder(address), sandbox.writable);
  return sandbox;
}

Sandbox make_sandbox(const descriptor::MissionSubsystem& subsystem, const std::filesystem::path& program,
                     const std::string& instance) {
  Sandbox sandbox = sandbox_of(subsystem, program, instance);
  for (const std::string& address : memory_addresses(subsystem, instance))
    if (!make_device_memory_folder(address)) std::erase(sandbox.writable, device_memory_folder(address));
  return sandbox;
}

std::string left_open(const Sandbox& sandbox) {
  std::string open;
  const auto add = [&](std::string_view what) { open.append(open.empty() ? "" : ", ").append(what); };
  if (sandbox.sockets.datagrams) add("all that listens by UDP");
  if (sandbox.sockets.local) add("all UNIX sockets that its user may open (a bus of his starts programs)");
  if (sandbox.queues) add("all message queues");
  if (std::ranges::find(sandbox.writable, "/dev/pts") != sandbox.writable.end()) add("all pseudo-terminals");
  return open;
}

}  // namespace hirosco::supervisor
