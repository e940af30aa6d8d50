// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"

/// Which executables a mission may start, by what is in them (docs/adr/0089).
namespace hirosco::descriptor {

/// Of SHA-256, as hexadecimal digits.
inline constexpr std::size_t digest_digits = 64;
/// Between the name of a program and that of one of its versions, in the name of a file: "arm@2".
inline constexpr char version_mark = '@';

/// One line of it.
struct Listed {
  std::string file;  ///< name, without a folder: "arm", or "arm@2" for a version of it
  std::string digest;  ///< lower case
  Location at;
};

struct Manifest {
  std::filesystem::path file;
  std::vector<Listed> listed;

  /// Nullptr: it is not in it.
  [[nodiscard]] const Listed* find(std::string_view name) const noexcept {
    const auto found = std::ranges::find(listed, name, &Listed::file);
    return found != listed.end() ? &*found : nullptr;
  }
};

}  // namespace hirosco::descriptor
