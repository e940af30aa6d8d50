// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/subsystem_sandbox.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/descriptor/model/member_reach.hpp"
#include "hirosco/descriptor/model/setting_files.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "hirosco/utilities/os/sandbox.hpp"
#include "hirosco/utilities/sanitizer.hpp"

namespace hirosco::supervisor {
namespace {

/// Where a file that a mission names really is.
[[nodiscard]] std::filesystem::path place_of(const std::filesystem::path& file) {
  const std::string text = file.string();
  if (!text.starts_with(shipped_prefix)) return std::filesystem::absolute(file);
  return find_shipped(std::string_view{text}.substr(shipped_prefix.size()));
}

void add_file(const std::filesystem::path& file, Sandbox& sandbox) {
  sandbox.readable.push_back(place_of(file).string());
}

/// All but what its devices' flows need.
[[nodiscard]] Sandbox without_flows(const descriptor::MissionSubsystem& subsystem,
                                    const std::filesystem::path& program) {
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
  for (const auto& configuration : subsystem.subsystem.configurations)
    for (const auto& use : configuration.devices)
      for (const auto& setting : use.settings)
        if (descriptor::names_file(setting)) add_file(descriptor::file_of(subsystem.subsystem, setting.value), sandbox);
  descriptor::let_in_links(subsystem, sandbox);
  return sandbox;
}

}  // namespace

ProcessLimits limits_of(const descriptor::Resources& resources) noexcept {
  using descriptor::Resource;
  ProcessLimits limits;
  constexpr std::uint64_t octets_per_kb = 1024;
  if (const auto memory_kb = amount_of(resources.most, Resource::Memory);
      memory_kb && !built_with_sanitizer && !sandbox_is_off())
    limits.memory_octets = *memory_kb * octets_per_kb;
  if (const auto descriptors = amount_of(resources.most, Resource::Descriptors)) limits.descriptors = *descriptors;
  return limits;
}

Sandbox sandbox_of(const descriptor::MissionSubsystem& subsystem, const std::filesystem::path& program,
                   const std::string& instance, ProcessUser user) {
  Sandbox sandbox = without_flows(subsystem, program);
  for (const FlowAddress& flow : descriptor::flows_of(subsystem.subsystem)) let_in(flow, instance, sandbox, user);
  return sandbox;
}

Sandbox make_sandbox(const descriptor::MissionSubsystem& subsystem, const std::filesystem::path& program,
                     const std::string& instance) {
  Sandbox sandbox = without_flows(subsystem, program);
  for (const FlowAddress& flow : descriptor::flows_of(subsystem.subsystem))
    if (make_place(flow, instance)) let_in(flow, instance, sandbox);
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

std::string shut_out(const Sandbox& had, const Sandbox& wants) {
  for (const std::string& place : wants.writable)
    if (std::ranges::find(had.writable, place) == had.writable.end()) return place;
  if (wants.sockets.local && !had.sockets.local) return "UNIX sockets";
  if (wants.sockets.datagrams && !had.sockets.datagrams) return "others by UDP";
  if (wants.queues && !had.queues) return "message queues";
  for (const std::uint16_t port : wants.sockets.ports)
    if (!had.sockets.streams && std::ranges::find(had.sockets.ports, port) == had.sockets.ports.end())
      return "TCP port " + std::to_string(port);
  return {};
}

}  // namespace hirosco::supervisor
