// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hirosco/utilities/enum_text.hpp"

/// What a subsystem takes of its computer, besides electrical power (paper 4.1; docs/adr/0080).
namespace hirosco::descriptor {

enum class Resource : std::uint8_t {
  Memory = 0,  ///< of its own, kB: what it may write and shares with nobody
  SharedMemory = 1,  ///< kB in RAM
  Threads = 2,
  Descriptors = 3,  ///< of files, sockets and the like
  Processor = 4,  ///< percent of one processor
  Pool = 5,  ///< blocks of one size; its own, so nobody else keeps books of it
  Ports = 6,  ///< of UDP and TCP
  Files = 7,  ///< open ones
  // Messages that wait for the supervisor; its own, as Pool is.
  WaitingAnswers = 8,
  WaitingEvents = 9,
  WaitingHousekeeping = 10,
  // Queues between the loops of a subsystem (docs/adr/0188); its own likewise.
  CycleCommands = 11,
  CycleAnswers = 12,  ///< octets, like those of every ring of reports
  CycleEvents = 13,
  CycleHousekeeping = 14,
  LoopRequests = 15,  ///< of the loop of services that is fullest, like the next
  LoopReports = 16,
  Channel = 17,  ///< what waits in the control channel towards the supervisor, kB; its own likewise
  Processes = 18,  ///< of the system; each subsystem is one (docs/adr/0220)
  Cores = 19,  ///< percent of one that a mission names (docs/adr/0234)
};
inline constexpr std::size_t counted_resources = 20;  ///< those among them of which there is no amount
inline constexpr std::size_t queues_of_subsystem = 7;  ///< from CycleCommands on

/// By Resource; empty = not declared, so not limited.
using Amounts = std::array<std::optional<std::uint32_t>, counted_resources>;
[[nodiscard]] constexpr std::optional<std::uint32_t> amount_of(const Amounts& amounts, Resource resource) noexcept {
  return amounts[static_cast<std::size_t>(resource)];
}
/// What a subsystem is promised of it: of processes itself, whatever its descriptor says, for its sandbox lets it start no other.
[[nodiscard]] constexpr std::optional<std::uint32_t> promised_of(const Amounts& most, Resource resource) noexcept {
  return resource == Resource::Processes ? 1U : amount_of(most, resource);
}
/// "kB", "%", or nothing.
[[nodiscard]] constexpr const char* unit_of(Resource resource) noexcept {
  return resource <= Resource::SharedMemory || resource == Resource::Channel ? " kB"
         : resource == Resource::Processor || resource == Resource::Cores    ? " %"
                                                                             : "";
}

/// Blocks of one size, there from Software-Init to Software-Deinit and never more.
struct Pool {
  std::uint32_t block_octets{};
  std::uint32_t blocks{};
};

/// With what stands beside each block (hirosco/resource/free_list.hpp).
[[nodiscard]] constexpr std::uint64_t octets_of(const Pool& pool) noexcept {
  constexpr std::uint64_t link_octets = 4;
  return (pool.block_octets + link_octets) * pool.blocks;
}

/// How many messages may wait for a supervisor that does not take them: answers, events and housekeeping apart, so that none is crowded
/// out by another kind.
using Waiting = std::array<std::uint32_t, 3>;
inline constexpr std::uint32_t default_waiting = 1024;
/// Of each kind: most are short, a few as long as a packet may be.
[[nodiscard]] constexpr std::array<Pool, 3> waiting_pools(std::uint32_t most) noexcept {
  constexpr std::uint32_t short_octets = 112, middle_octets = 512, longest_octets = 16 + 4096;
  constexpr std::uint32_t short_to_middle = 4, short_to_longest = 21;
  return {{{short_octets, most}, {middle_octets, most / short_to_middle}, {longest_octets, most / short_to_longest}}};
}
[[nodiscard]] constexpr std::uint64_t octets_of(const Waiting& waiting) noexcept {
  std::uint64_t octets = 0;
  for (const std::uint32_t most : waiting)
    for (const Pool& pool : waiting_pools(most)) octets += std::uint64_t{pool.block_octets} * pool.blocks;
  return octets;
}

/// The queues between the loops of a subsystem, as they lie in memory (docs/adr/0188). Rings of octets are powers of two. Larger than
/// this where nobody says how large, and the descriptor itself puts more into them.
struct Queues {
  std::uint32_t commands{64};  ///< from the service loop to the cycle
  std::uint32_t answers_octets{32U << 10};  ///< from the cycle to the service loop, like the next two
  std::uint32_t events_octets{32U << 10};
  std::uint32_t housekeeping_octets{64U << 10};
  std::uint32_t loop_reports_octets{64U << 10};  ///< from each loop of services of its own to the service loop
  bool operator==(const Queues&) const = default;
};
inline constexpr std::uint32_t most_commands = 1024, most_ring_kb = 4096;
/// What a command and a record take at most: who makes them says so where it is compiled.
inline constexpr std::uint32_t command_octets = 288, report_head_octets = 24, reason_octets = 80;
/// Of a record in a ring: its length, its octets, and what fills them up to eight.
[[nodiscard]] constexpr std::uint64_t octets_of_record(std::uint64_t octets) noexcept {
  constexpr std::uint64_t length_octets = 8, grain = 8;
  return length_octets + (octets + grain - 1) / grain * grain;
}
/// Room for so many requests of the longest packet.
[[nodiscard]] constexpr std::uint64_t loop_requests_octets(std::uint32_t queue) noexcept {
  constexpr std::uint64_t longest_packet = 4096, head = 4;
  // One more: where a ring ends the next record may not fit.
  return (std::uint64_t{queue} + 1) * octets_of_record(head + longest_packet);
}
[[nodiscard]] constexpr std::uint64_t octets_of(const Queues& queues) noexcept {
  return std::uint64_t{queues.commands} * command_octets + queues.answers_octets + queues.events_octets +
         queues.housekeeping_octets;
}

inline constexpr std::size_t most_pools = 8;
inline constexpr std::uint32_t default_warning_percent = 75;

/// Of a subsystem.
struct Resources {
  Amounts most{};
  std::vector<Pool> pools;  ///< by ascending block size
  Waiting waiting{default_waiting, default_waiting, default_waiting};
  Queues queues;
  /// What may wait in the control channel, each way, in kB: of the system's memory in a socket, which counts its own beside each message; a
  /// message for each where subsystems are threads or simulated. Empty: as the deployment has it (docs/adr/0215).
  std::optional<std::uint32_t> channel_kb{};
  std::uint32_t warning_percent{default_warning_percent};  ///< of a limit or pool: where its use becomes an event
};

}  // namespace hirosco::descriptor

namespace hirosco {
template <>
struct EnumTexts<descriptor::Resource> {
  using enum descriptor::Resource;
  static constexpr auto table = enum_table<descriptor::Resource>({{Memory, "memory"},
                                                                  {SharedMemory, "shared memory"},
                                                                  {Threads, "threads"},
                                                                  {Descriptors, "descriptors"},
                                                                  {Processor, "processor"},
                                                                  {Pool, "pool"},
                                                                  {Ports, "ports"},
                                                                  {Files, "files"},
                                                                  {WaitingAnswers, "answers that wait"},
                                                                  {WaitingEvents, "events that wait"},
                                                                  {WaitingHousekeeping, "housekeeping that waits"},
                                                                  {CycleCommands, "commands to the cycle"},
                                                                  {CycleAnswers, "answers of the cycle"},
                                                                  {CycleEvents, "events of the cycle"},
                                                                  {CycleHousekeeping, "housekeeping of the cycle"},
                                                                  {LoopRequests, "requests to a service loop"},
                                                                  {LoopReports, "reports of a service loop"},
                                                                  {Channel, "control channel"},
                                                                  {Processes, "processes"},
                                                                  {Cores, "cores"}});
};
}  // namespace hirosco
