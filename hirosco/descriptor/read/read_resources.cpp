// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <bit>

#include "hirosco/descriptor/read/detail/mission_parts.hpp"
#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

/// What a subsystem takes, and what a mission has of it (docs/adr/0080).
namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t most_kb = std::int64_t{1} << 30;
constexpr std::int64_t largest_block = std::int64_t{1} << 24, most_blocks = std::int64_t{1} << 24;
/// Of all pools of a subsystem.
constexpr std::uint64_t most_pool_octets = std::uint64_t{1} << 31;
/// What a process has open before its author opens anything: standard streams, channel, pages, its waits, links and devices.
constexpr std::int64_t least_descriptors = 24;
/// Messages of one kind: enough for the answers to a few telecommands, and few enough to fit into the memory of a process.
constexpr std::int64_t least_waiting = 128, most_waiting = 65'536;
/// To the cycle: enough to bring it up. A ring of octets takes the longest packet by half of itself (utilities/record_ring.hpp).
constexpr std::int64_t least_commands = 16;
constexpr std::int64_t least_ring_kb = 16;
/// Some of the longest packets; and what Linux grants everybody (net.core.wmem_max as it comes).
constexpr std::int64_t least_channel_kb = 64, most_channel_kb = 416;
/// What the framework itself starts: service loop and cycle.
constexpr std::int64_t least_threads = 2;
/// Of all subsystems, each of which is one.
constexpr std::int64_t most_processes = 65'535;

void read_pool(const xml::Element& element, std::vector<Pool>& pools, Problems& problems) {
  Attributes attributes{element, problems};
  no_children(element, problems);
  Pool pool;
  pool.block_octets = attributes.required_integer<std::uint32_t>("block", 16, largest_block);
  pool.blocks = attributes.required_integer<std::uint32_t>("count", 1, most_blocks);
  if (pool.block_octets == 0 || pool.blocks == 0) return;
  // As large as they are in memory: two pools of one size would be one.
  constexpr std::uint32_t grain = 16;
  pool.block_octets = (pool.block_octets + grain - 1) / grain * grain;
  const auto twice = std::ranges::find(pools, pool.block_octets, &Pool::block_octets);
  if (twice != pools.end())
    return problems.add(element, "E0240", fmt::format("a second pool of blocks of {} octets", pool.block_octets),
                        "sizes are rounded up to 16 octets: make it one pool");
  pools.push_back(pool);
}

}  // namespace

Amounts read_amounts(Attributes& attributes) {
  Amounts amounts;
  const auto take = [&](Resource resource, std::optional<std::int64_t> value) {
    if (value) amounts[static_cast<std::size_t>(resource)] = static_cast<std::uint32_t>(*value);
  };
  constexpr std::int64_t least_kb = 4096;
  take(Resource::Memory, attributes.integer("memory_kB", least_kb, most_kb));
  take(Resource::SharedMemory, attributes.integer("shared_memory_kB", 64, most_kb));
  take(Resource::Threads, attributes.integer("threads", least_threads, 1'000'000));
  take(Resource::Descriptors, attributes.integer("descriptors", least_descriptors, 1'000'000));
  take(Resource::Processor, attributes.integer("processor_percent", 1, 100'000));
  take(Resource::Ports, attributes.integer("ports", 0, 65'535));
  take(Resource::Files, attributes.integer("files", 0, 1'000'000));
  return amounts;
}

void read_resources(const xml::Element& element, Resources& resources, Problems& problems) {
  Attributes attributes{element, problems};
  resources.most = read_amounts(attributes);
  resources.warning_percent = attributes.integer_or<std::uint32_t>("warning_percent", 1, 100, default_warning_percent);
  const auto waiting = [&](const char* name) {
    return attributes.integer_or<std::uint32_t>(name, least_waiting, most_waiting, default_waiting);
  };
  resources.waiting = {waiting("waiting_answers"), waiting("waiting_events"), waiting("waiting_housekeeping")};
  Queues& queues = resources.queues;
  queues.commands =
      attributes.integer_or<std::uint32_t>("cycle_commands", least_commands, most_commands, queues.commands);
  // As large as they are in memory: positions in a ring are cut out of a number.
  const auto ring = [&](const char* name, std::uint32_t otherwise) {
    constexpr std::uint32_t kb = 1024;
    return std::bit_ceil(attributes.integer_or<std::uint32_t>(name, least_ring_kb, most_ring_kb, otherwise / kb)) * kb;
  };
  queues.answers_octets = ring("cycle_answers_kB", queues.answers_octets);
  queues.events_octets = ring("cycle_events_kB", queues.events_octets);
  queues.housekeeping_octets = ring("cycle_housekeeping_kB", queues.housekeeping_octets);
  queues.loop_reports_octets = ring("loop_reports_kB", queues.loop_reports_octets);
  if (const auto kb = attributes.integer("channel_kB", least_channel_kb, most_channel_kb))
    resources.channel_kb = static_cast<std::uint32_t>(*kb);
  each_child(element, problems,
             {{"Pool", [&](const auto& pool) { read_pool(pool, resources.pools, problems); }, most_pools}});
  std::ranges::sort(resources.pools, {}, &Pool::block_octets);
  std::uint64_t octets = 0;
  for (const Pool& pool : resources.pools) octets += octets_of(pool);
  const auto memory_kb = amount_of(resources.most, Resource::Memory);
  const std::uint64_t limit = memory_kb ? std::uint64_t{*memory_kb} * 1024 : most_pool_octets;
  if (octets > limit)
    problems.add(element, "E0240", fmt::format("the pools take {} octets together", octets),
                 fmt::format("at most {}{}", limit, memory_kb ? ", the memory that it says" : ""));
}

void read_resources(const xml::Element& element, Mission& mission, Problems& problems) {
  Attributes attributes{element, problems};
  no_children(element, problems);
  mission.budget = read_amounts(attributes);
  if (const auto processes = attributes.integer("processes", 1, most_processes))
    mission.budget[static_cast<std::size_t>(Resource::Processes)] = static_cast<std::uint32_t>(*processes);
}

/// Whoever says nothing would take from what is promised to the others.
void check_resources(const xml::Element& element, const Mission& mission, Problems& problems) {
  for (std::size_t i = 0; i < counted_resources; ++i) {
    const auto resource = static_cast<Resource>(i);
    const auto budget = amount_of(mission.budget, resource);
    if (!budget) continue;
    std::uint64_t sum = 0;
    for (const MissionSubsystem& member : mission.subsystems) {
      const auto most = promised_of(member.subsystem.resources.most, resource);
      sum += most.value_or(0);
      if (!most)
        problems.add(element, "E0350",
                     fmt::format("the mission limits {}, and '{}' does not say how much it takes", to_text(resource),
                                 member.subsystem.name),
                     "say it in <Resources> of its descriptor");
    }
    if (sum > *budget)
      problems.warn(place(element.at), "E0410",
                    fmt::format("all subsystems together take {}{} of {}, the mission has {}{}", sum, unit_of(resource),
                                to_text(resource), *budget, unit_of(resource)),
                    "whoever is started last is refused", element.name.size() + 1);
  }
}

}  // namespace hirosco::descriptor::detail
