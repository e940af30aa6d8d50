// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/resource_marks.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "hirosco/descriptor/model/framework_parameters.hpp"

namespace hirosco::tools {
namespace {

using descriptor::Resource;

/// What is limited by a number, its member, whose mark is called with _HIGH behind, and its attribute.
struct CountedResource {
  Resource resource;
  const char* member;
  const char* attribute;
};
constexpr std::array told_by_number{CountedResource{Resource::Memory, "MEMORY", "memory_kB"},
                                    CountedResource{Resource::SharedMemory, "SHARED_MEMORY", "shared_memory_kB"},
                                    CountedResource{Resource::Threads, "THREADS", "threads"},
                                    CountedResource{Resource::Descriptors, "DESCRIPTORS", "descriptors"},
                                    CountedResource{Resource::Processor, "PROCESSOR", "processor_percent"},
                                    CountedResource{Resource::Ports, "PORTS", "ports"},
                                    CountedResource{Resource::Files, "FILES", "files"}};
constexpr std::array waiting_attributes{"waiting_answers", "waiting_events", "waiting_housekeeping"};
constexpr std::uint64_t all_percent = 100;
constexpr const char* high_mark = "_HIGH";

/// Rounded up: what was taken is never told as less.
[[nodiscard]] constexpr std::uint64_t part_of(std::uint64_t amount, std::uint64_t part, std::uint64_t of) noexcept {
  return (amount * part + of - 1) / of;
}

}  // namespace

std::optional<std::uint64_t> ResourceRow::percent() const noexcept {
  if (!declared || *declared == 0) return std::nullopt;
  return part_of(high, all_percent, *declared);
}

void ResourceMarks::hear(std::span<const pus::HousekeepingValue> values, OnboardTime at) {
  const std::string stats = std::string{descriptor::framework_parameter::resource_stats} + ".";
  for (const pus::HousekeepingValue& value : values) {
    if (!value.name.starts_with(stats)) continue;
    const std::string member = value.name.substr(stats.size());
    std::vector<std::uint64_t> numbers;
    for (const double number : value.values) numbers.push_back(static_cast<std::uint64_t>(number));
    if (!member.ends_with(high_mark)) {
      Told& told = now_[member];
      if (told.numbers.empty() || at >= told.at) told = {at, std::move(numbers)};
      continue;
    }
    // The marks of a process end with it; those of the next begin at nothing.
    auto& so_far = high_[member];
    so_far.resize(std::max(so_far.size(), numbers.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i) so_far[i] = std::max(so_far[i], numbers[i]);
  }
}

std::uint64_t ResourceMarks::high(const std::string& member, std::size_t element) const {
  const auto found = high_.find(member + high_mark);
  return found != high_.end() && element < found->second.size() ? found->second[element] : 0;
}

std::optional<std::uint64_t> ResourceMarks::now(const std::string& member, std::size_t element) const {
  const auto found = now_.find(member);
  if (found == now_.end() || element >= found->second.numbers.size()) return std::nullopt;
  return found->second.numbers[element];
}

std::vector<ResourceRow> ResourceMarks::rows(const descriptor::SubsystemDescriptor& subsystem) const {
  const descriptor::Resources& declared = subsystem.resources;
  std::vector<ResourceRow> rows;
  for (const CountedResource& each : told_by_number)
    rows.push_back({each.attribute, amount_of(declared.most, each.resource), high(each.member), now(each.member)});
  for (std::size_t i = 0; i < declared.pools.size(); ++i)
    rows.push_back({"Pool " + std::to_string(declared.pools[i].block_octets), declared.pools[i].blocks, high("POOL", i),
                    now("POOL_USED", i)});
  for (std::size_t i = 0; i < waiting_attributes.size(); ++i)
    rows.push_back({waiting_attributes[i], declared.waiting[i], high("WAITING", i), now("WAITING", i)});
  // Told as a share: taken back to the unit that is declared.
  const auto queue = [&](Resource resource, const char* attribute, std::uint64_t room) {
    const auto place = static_cast<std::size_t>(resource) - static_cast<std::size_t>(Resource::CycleCommands);
    ResourceRow row{attribute, room, part_of(room, high("QUEUES", place), all_percent)};
    if (const auto share = now("QUEUES", place)) row.now = part_of(room, *share, all_percent);
    rows.push_back(std::move(row));
  };
  constexpr std::uint64_t kb = 1024;
  queue(Resource::CycleCommands, "cycle_commands", declared.queues.commands);
  queue(Resource::CycleAnswers, "cycle_answers_kB", declared.queues.answers_octets / kb);
  queue(Resource::CycleEvents, "cycle_events_kB", declared.queues.events_octets / kb);
  queue(Resource::CycleHousekeeping, "cycle_housekeeping_kB", declared.queues.housekeeping_octets / kb);
  if (declared.channel_kb) queue(Resource::Channel, "channel_kB", *declared.channel_kb);
  if (subsystem.service_loops.empty()) return rows;
  // The share of the one that was fullest: which one of several that is nobody tells, so in no unit of theirs.
  if (subsystem.service_loops.size() == 1)
    queue(Resource::LoopRequests, "queue of a loop", subsystem.service_loops[0].queue);
  else queue(Resource::LoopRequests, "fullest queue of a loop, %", all_percent);
  queue(Resource::LoopReports, "loop_reports_kB", declared.queues.loop_reports_octets / kb);
  return rows;
}

}  // namespace hirosco::tools
