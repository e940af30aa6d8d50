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
};
inline constexpr std::size_t counted_resources = 8;  ///< Pool among them, of which there is no amount

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

inline constexpr std::size_t most_pools = 8;
inline constexpr std::uint32_t default_warning_percent = 75;

/// Of a subsystem.
struct Resources {
  Amounts most{};
  std::vector<Pool> pools;  ///< by ascending block size
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
                                                                  {Files, "files"}});
};
}  // namespace hirosco
