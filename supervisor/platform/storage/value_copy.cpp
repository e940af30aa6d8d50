// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/value_copy.hpp"

#include "hirosco/utilities/crc32.hpp"

namespace hirosco::supervisor {
namespace {

constexpr std::uint32_t copy_magic = 0x48565043;  // "HVPC"
constexpr std::size_t sum_octets = 4;

}  // namespace

std::vector<std::byte> write_copy(const ValueCopy& copy) {
  std::vector<std::byte> octets(value_copy_overhead + copy.values.size());
  OctetWriter writer{octets};
  writer.put(copy_magic).put(value_copy_version).put(copy.layout).put(copy.sequence);
  writer.put(static_cast<std::int64_t>(copy.since.time_since_epoch().count()));
  writer.put(static_cast<std::uint32_t>(copy.values.size())).put(Octets{copy.values});
  writer.put(crc32(Octets{octets}.first(octets.size() - sum_octets)));
  return octets;
}

std::expected<ValueCopy, CopyFault> read_copy(Octets octets) {
  if (octets.size() < value_copy_overhead) return std::unexpected{CopyFault::Damaged};
  // First of all, as what says the version may be damaged itself. Every version has its sum at the end.
  if (OctetReader{octets.last(sum_octets)}.get<std::uint32_t>() != crc32(octets.first(octets.size() - sum_octets)))
    return std::unexpected{CopyFault::Damaged};
  OctetReader reader{octets};
  if (reader.get<std::uint32_t>() != copy_magic) return std::unexpected{CopyFault::Damaged};
  if (reader.get<std::uint16_t>() != value_copy_version) return std::unexpected{CopyFault::Version};
  ValueCopy copy;
  copy.layout = reader.get<std::uint64_t>();
  copy.sequence = reader.get<std::uint64_t>();
  copy.since = OnboardTime{Duration{reader.get<std::int64_t>()}};
  const auto size = reader.get<std::uint32_t>();
  if (size != octets.size() - value_copy_overhead) return std::unexpected{CopyFault::Damaged};
  const Octets values = reader.get(size);
  copy.values.assign(values.begin(), values.end());
  return copy;
}

}  // namespace hirosco::supervisor
