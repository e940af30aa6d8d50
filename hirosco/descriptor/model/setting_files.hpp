// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/result.hpp"

/// Settings of devices that hold for a subsystem as a whole, and files that they name (docs/adr/0110): read by the subsystem and by what
/// stands in for its device, and by nobody else.
namespace hirosco::descriptor {

/// A device's setting with such a name names a file.
inline constexpr std::string_view file_setting_ending = "_FILE";
[[nodiscard]] inline bool names_file(const Setting& setting) { return setting.name.ends_with(file_setting_ending); }

/// Where it is: beside the descriptor, or with HIROSCO ("@hirosco/..."), which file_system() finds.  Realtime: allocates.
[[nodiscard]] inline std::filesystem::path file_of(const SubsystemDescriptor& subsystem, std::string_view value) {
  if (value.starts_with('@')) return value;
  return (subsystem.file.parent_path() / value).lexically_normal();
}

/// What every configuration that says this setting of that device says; empty: none says anything. Mismatch: they say different things, of what
/// is one whatever the configuration.  Realtime: allocates.
[[nodiscard]] inline Result<std::string> setting_of_all(const SubsystemDescriptor& subsystem, std::string_view device,
                                                        std::string_view name) {
  const std::string* found = nullptr;
  for (const auto& configuration : subsystem.configurations)
    for (const auto& use : configuration.devices) {
      if (subsystem.devices[use.device].name != device) continue;
      for (const auto& setting : use.settings) {
        if (setting.name != name) continue;
        if (found != nullptr && *found != setting.value)
          return fail(ErrorCode::Mismatch, "configurations say different things of a device that is one");
        found = &setting.value;
      }
    }
  return found != nullptr ? *found : std::string{};
}

}  // namespace hirosco::descriptor
