// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco::tools {

/// What a subsystem declares of one resource beside the most that it has taken: as `<Resources>` calls it, in that unit.
struct ResourceRow {
  std::string attribute;  ///< "memory_kB", "Pool 64"; of several loops of services the share of the fullest, in percent
  std::optional<std::uint64_t> declared{};  ///< nothing: it is not limited
  std::uint64_t high{0};
  std::optional<std::uint64_t> now{};  ///< nothing: nobody has told it, or its process does not run
  /// Of what is declared, rounded up; nothing where that is nothing.
  [[nodiscard]] std::optional<std::uint64_t> percent() const noexcept;
};

/// The high-water marks of one subsystem, as its RESOURCE_STATS told them, over all its lives, and what it takes now.
class ResourceMarks {
 public:
  /// The values of one of its reports, in any order of their times.
  void hear(std::span<const pus::HousekeepingValue> values, OnboardTime at = {});
  /// Its process does not run: what it took was given back.
  void forget_now() { now_.clear(); }
  /// No report of it had RESOURCE_STATS.
  [[nodiscard]] bool silent() const noexcept { return high_.empty(); }
  /// In the order of the descriptor; pools by their size, and loops of services where it has some.
  [[nodiscard]] std::vector<ResourceRow> rows(const descriptor::SubsystemDescriptor& subsystem) const;

 private:
  struct Told {
    OnboardTime at{};
    std::vector<std::uint64_t> numbers;
  };
  [[nodiscard]] std::uint64_t high(const std::string& member, std::size_t element = 0) const;
  [[nodiscard]] std::optional<std::uint64_t> now(const std::string& member, std::size_t element = 0) const;

  std::map<std::string, std::vector<std::uint64_t>> high_;  ///< by the name of the member
  std::map<std::string, Told> now_;  ///< likewise; the newest
};

}  // namespace hirosco::tools
