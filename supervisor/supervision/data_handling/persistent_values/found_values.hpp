// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "supervisor/platform/storage/value_copy.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"

namespace hirosco::supervisor {

/// Events of the stored values that were found at the start, told when the ground link is there, but not later than `patience`: one that
/// nobody can hear yet would be in the log only. Thread: the supervisor's.
class FoundValues {
 public:
  static constexpr Duration patience = std::chrono::seconds{10};

  FoundValues(Craft& craft, OwnSubsystem& own) : craft_{craft}, own_{own} {}

  void begin(TimePoint now) noexcept { begun_ = now; }
  /// A subsystem begins with so many, of that time.
  void taken(std::uint16_t apid, std::size_t values, OnboardTime since);
  /// The first or second copy of its values is not used: the story has it at once.
  void refused(std::uint16_t apid, std::size_t copy, CopyFault fault);
  void tell(TimePoint now);

 private:
  Craft& craft_;
  OwnSubsystem& own_;
  std::vector<std::pair<std::string_view, std::array<double, 3>>> news_;
  TimePoint begun_{};
};

}  // namespace hirosco::supervisor
