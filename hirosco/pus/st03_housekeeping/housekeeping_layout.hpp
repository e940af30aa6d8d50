// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::pus {

inline constexpr std::size_t max_housekeeping_octets = max_telemetry_octets - telemetry_overhead_octets;

/// One value that a structure may have, resolved.
struct SampledValue {
  std::uint32_t wire{};              ///< ParameterId::wire() of the parameter or member
  std::uint16_t parameter{};         ///< index into SubsystemDescriptor::parameters
  std::int16_t member{-1};           ///< as ParameterRef::member, -1 = whole
  std::uint16_t octets{};
};

/// A resolved report structure: the form of its reports. Its lists have their room from its making on: what a telecommand defines
/// or lengthens in flight takes nothing from the heap (adr 0220).
class HousekeepingLayout {
 public:
  /// In front of the values of a report.
  static constexpr std::size_t structure_id_octets = sizeof(std::uint16_t);
  /// What a count of TC[3,1] says at most: values sampled once, sets, values of a set.
  static constexpr std::size_t most_listed = 255;
  /// The values of all sets: more do not fit TM[3,10], where each takes four octets behind the fields of its structure.
  static constexpr std::size_t most_repeated = (max_housekeeping_octets - 12) / 4;

  struct Set {
    std::uint16_t repetitions{};  ///< divides the interval
    std::uint16_t first{};  ///< of its values, among those of all sets
    std::uint16_t count{};
    std::uint32_t octets{};  ///< of its values, sampled one time
  };

  HousekeepingLayout();
  HousekeepingLayout(const HousekeepingLayout&) = delete;
  /// Does not allocate.
  HousekeepingLayout& operator=(const HousekeepingLayout&) = default;

  /// An empty one, of values of `table`, which outlives it.
  void begin(std::span<const SampledValue> table, std::uint16_t id, std::uint32_t interval) noexcept;
  /// Values by their places in the table, a set's to the set that was begun last. False: there is no room.
  [[nodiscard]] bool add_once(std::size_t place) noexcept;
  [[nodiscard]] bool begin_set(std::uint16_t repetitions) noexcept;
  [[nodiscard]] bool add_to_set(std::size_t place) noexcept;

  /// Places in the table.
  [[nodiscard]] std::span<const std::uint32_t> once() const noexcept { return once_; }
  [[nodiscard]] std::span<const Set> sets() const noexcept { return sets_; }
  [[nodiscard]] std::span<const std::uint32_t> values_of(const Set& set) const noexcept {
    return std::span{repeated_}.subspan(set.first, set.count);
  }
  [[nodiscard]] const SampledValue& value(std::uint32_t place) const noexcept { return table_[place]; }
  [[nodiscard]] bool contains(std::size_t place) const noexcept;

  /// Octets of the values that are sampled once.
  [[nodiscard]] std::size_t once_octets() const noexcept { return once_octets_; }
  /// Octets of the source data of one report.
  [[nodiscard]] std::size_t report_octets() const noexcept;
  /// All repetition numbers are greater than 0 and divide the interval.
  [[nodiscard]] bool allows(std::uint32_t cycles) const noexcept;

  std::uint16_t id{};
  std::uint32_t interval{};  ///< cycles

 private:
  std::span<const SampledValue> table_;
  std::vector<std::uint32_t> once_;
  std::vector<std::uint32_t> repeated_;
  std::vector<Set> sets_;
  std::size_t once_octets_{0};
};

}  // namespace hirosco::pus
