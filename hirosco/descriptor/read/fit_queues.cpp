// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <bit>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

/// That the queues of a subsystem hold what its descriptor itself puts into them at one time (docs/adr/0188).
namespace hirosco::descriptor::detail {
namespace {

/// Records that may be in a ring at once.
struct RingNeed {
  std::uint64_t octets{0};
  std::uint64_t longest{0};
  void add(std::uint64_t payload, std::uint64_t times = 1) noexcept {
    const std::uint64_t record = octets_of_record(report_head_octets + payload);
    octets += record * times;
    longest = std::max(longest, record);
  }
  /// Where a ring ends the next record may not fit, and begins anew in front.
  [[nodiscard]] std::uint64_t with_end() const noexcept { return octets + longest; }
};

[[nodiscard]] std::uint64_t octets_of_arguments(const Event& event) noexcept {
  std::uint64_t octets = 0;
  for (const Field& argument : event.arguments) octets += argument.octets();
  return octets;
}

[[nodiscard]] std::uint64_t octets_of_report(const SubsystemDescriptor& subsystem,
                                             const HousekeepingStructure& structure) {
  const auto sum = [&](const std::vector<ParameterRef>& references) {
    std::uint64_t octets = 0;
    for (const ParameterRef& each : references) octets += subsystem.parameters[each.parameter].octets(each.member);
    return octets;
  };
  std::uint64_t octets = sum(structure.sampled_once);
  for (const auto& set : structure.sampled_repeatedly) octets += set.repetitions * sum(set.parameters);
  // One that is longer is refused for that (E0215).
  return sizeof structure.id + std::min<std::uint64_t>(octets, max_housekeeping_octets);
}

/// Each answer that a full queue of commands gets, and each event of the framework once: of the half that progress leaves alone.
[[nodiscard]] std::uint64_t answers_needed(const SubsystemDescriptor& subsystem) {
  RingNeed need;
  need.add(0, subsystem.resources.queues.commands);  // started
  need.add(reason_octets, subsystem.resources.queues.commands);  // and ended, in words
  for (const Event& event : subsystem.events)
    if (event.id >= framework_event::first) need.add(octets_of_arguments(event));
  return 2 * need.with_end();
}

/// Each event of the author once, in one cycle. Remarks have the first half only.
[[nodiscard]] std::uint64_t events_needed(const SubsystemDescriptor& subsystem) {
  RingNeed remarks, all;
  for (const Event& event : subsystem.events) {
    if (event.id >= framework_event::first) continue;
    all.add(octets_of_arguments(event));
    if (event.severity < Severity::Medium) remarks.add(octets_of_arguments(event));
  }
  return std::max(all.with_end(), 2 * remarks.with_end());
}

/// All structures of a configuration in one cycle, as where the least interval divides the others.
[[nodiscard]] std::uint64_t housekeeping_needed(const SubsystemDescriptor& subsystem) {
  RingNeed common;
  for (const auto& structure : subsystem.housekeeping) common.add(octets_of_report(subsystem, structure));
  std::uint64_t most = common.with_end();
  for (const Configuration& configuration : subsystem.configurations) {
    RingNeed need = common;
    for (const auto& structure : configuration.housekeeping) need.add(octets_of_report(subsystem, structure));
    most = std::max(most, need.with_end());
  }
  return most;
}

/// What enters a state, tests, goes over to another configuration and calls a function, and each link of a configuration.
[[nodiscard]] std::uint64_t commands_needed(const SubsystemDescriptor& subsystem) {
  constexpr std::uint64_t of_framework = 4;
  std::uint64_t links = 0;
  for (const Configuration& configuration : subsystem.configurations)
    links = std::max<std::uint64_t>(links, configuration.provides.size() + configuration.requires_.size());
  return of_framework + links;
}

/// The longest report beside the answers to all requests that may wait: of the half that is kept for who asked.
[[nodiscard]] std::uint64_t loop_reports_needed(std::uint32_t queue) noexcept {
  constexpr std::uint64_t longest_packet = 4096, verification_octets = 3 * 48 + 128;
  return 2 * (longest_packet + queue * verification_octets);
}

}  // namespace

void fit_queues(const xml::Element& root, SubsystemDescriptor& subsystem, Problems& problems) {
  const auto found = std::ranges::find(root.children, "Resources", &xml::Element::name);
  const xml::Element& element = found != root.children.end() ? *found : root;
  // What nobody has said is as much as is needed; what somebody has said is not taken for more.
  const auto said = [&](std::string_view attribute) {
    return found != root.children.end() &&
           std::ranges::find(element.attributes, attribute, &xml::Attribute::name) != element.attributes.end();
  };
  Queues& queues = subsystem.resources.queues;
  if (const std::uint64_t needed = commands_needed(subsystem); needed > queues.commands) {
    if (!said("cycle_commands") && needed <= most_commands) queues.commands = static_cast<std::uint32_t>(needed);
    else
      problems.add(
          element, "E0369",
          fmt::format("its queue of commands to the cycle holds {}, and its links and changes of state need {}",
                      queues.commands, needed),
          fmt::format("cycle_commands=\"{}\" or more in <Resources>", needed));
  }
  const auto ring = [&](std::uint64_t needed, std::uint32_t& octets, const char* attribute, const char* what) {
    constexpr std::uint64_t kb = 1024;
    if (needed <= octets) return;
    const std::uint64_t suffices = std::bit_ceil((needed + kb - 1) / kb);
    if (!said(attribute) && suffices <= most_ring_kb) octets = static_cast<std::uint32_t>(suffices * kb);
    else
      problems.add(element, "E0369", fmt::format("{} take {} octets, and their ring has {}", what, needed, octets),
                   fmt::format("{}=\"{}\" or more in <Resources>", attribute, suffices));
  };
  ring(answers_needed(subsystem), queues.answers_octets, "cycle_answers_kB",
       "twice the answers to as many commands as may wait and each event of the framework");
  ring(events_needed(subsystem), queues.events_octets, "cycle_events_kB",
       "the events of one cycle, each once, or twice those below medium,");
  ring(housekeeping_needed(subsystem), queues.housekeeping_octets, "cycle_housekeeping_kB",
       "the housekeeping reports that one cycle may make");
  for (const ServiceLoop& loop : subsystem.service_loops)
    ring(loop_reports_needed(loop.queue), queues.loop_reports_octets, "loop_reports_kB",
         "twice the longest report of a service loop and the answers to as many requests as may wait");
  std::uint64_t octets = octets_of(queues) + octets_of(subsystem.resources.waiting), pools = 0;
  for (const ServiceLoop& loop : subsystem.service_loops)
    octets += std::bit_ceil(loop_requests_octets(loop.queue)) + queues.loop_reports_octets;
  for (const Pool& pool : subsystem.resources.pools) pools += octets_of(pool);
  const auto memory_kb = amount_of(subsystem.resources.most, Resource::Memory);
  if (!memory_kb) return;
  const std::uint64_t limit = std::uint64_t{*memory_kb} * 1024;
  if (pools > limit || pools + octets <= limit) return;  // E0240 says the first
  problems.add(
      element, "E0359",
      fmt::format("its pools, its queues and what may wait for the supervisor take {} octets together", pools + octets),
      fmt::format("at most {}, the memory that it says: fewer of them, or more memory_kB", limit));
}

}  // namespace hirosco::descriptor::detail
