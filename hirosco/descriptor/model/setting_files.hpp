// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "hirosco/descriptor/model/subsystem.hpp"

/// Files that settings of devices name (docs/adr/0110): read by the subsystem and by what stands in for its device, and by nobody else.
namespace hirosco::descriptor {

/// A device's setting with such a name names a file.
inline constexpr std::string_view file_setting_ending = "_FILE";
[[nodiscard]] inline bool names_file(const Setting& setting) { return setting.name.ends_with(file_setting_ending); }

/// Where it is: beside the descriptor, or with HIROSCO ("@hirosco/..."), which file_system() finds.  Realtime: allocates.
[[nodiscard]] inline std::filesystem::path file_of(const Subsystem& subsystem, std::string_view value) {
  if (value.starts_with('@')) return value;
  return (subsystem.file.parent_path() / value).lexically_normal();
}

}  // namespace hirosco::descriptor
