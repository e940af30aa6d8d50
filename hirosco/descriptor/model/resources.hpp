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
};
inline constexpr std::size_t counted_resources = 11;  ///< those among them of which there is no amount

/// By Resource; empty = not declared, so not limited.
using Amounts = std::array<std::optional<std::uint32_t>, counted_resources>;
[[nodiscard]] constexpr std::optional<std::uint32_t> amount_of(const Amounts& amounts, Resource resource) noexcept {
  return amounts[static_cast<std::size_t>(resource)];
}
/// "kB", "%", or nothing.
[[nodiscard]] constexpr const char* unit_of(Resource resource) noexcept {
  return resource <= Resource::SharedMemory ? " kB" : resource == Resource::Processor ? " %" : "";
}

/// Blocks of one size, there from the start and never more.
struct Pool {
  std::uint32_t block_octets{};
  std::uint32_t blocks{};
};

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

inline constexpr std::size_t most_pools = 8;
inline constexpr std::uint32_t default_warning_percent = 75;

/// Of a subsystem.
struct Resources {
  Amounts most{};
  std::vector<Pool> pools;  ///< by ascending block size
  Waiting waiting{default_waiting, default_waiting, default_waiting};
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
                                                                  {WaitingHousekeeping, "housekeeping that waits"}});
};
}  // namespace hirosco
