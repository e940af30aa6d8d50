// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"

namespace hirosco::descriptor::detail {

/// A mission while it is read: what is known of it by now, and what is wrong with it. Who reads a part adds to this.
struct MissionDraft {
  /// A subsystem of the mission, with `supervisor` also the supervisor; reported when there is none, unless it may be one that could not be read.
  [[nodiscard]] const SubsystemDescriptor* find(const xml::Attribute& at, std::string_view name, bool supervisor);

  Problems& problems;  ///< of the mission's own file
  Mission mission{};
  bool whole{true};  ///< each subsystem could be read: else names may be missing for that reason only
  std::size_t doubtful_links{0};  ///< that were reported: what a mode establishes cannot be judged then
  std::vector<std::vector<Diagnostic>> subsystem_problems{};  ///< of the files that it names, each file's in its order
  std::vector<Diagnostic> subsystem_warnings{};  ///< of the descriptors that it names
};

}  // namespace hirosco::descriptor::detail
