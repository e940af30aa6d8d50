// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"

/// `hirosco new robot`: the meshes by which an arm keeps from itself come along (docs/adr/0131).
namespace hirosco::tools {

/// What a folder takes at most; each file has the limit of its source, 4 MiB.
inline constexpr std::size_t most_taken_meshes = 200, most_taken_octets = 64 * 1024 * 1024;

struct TakenMeshes {
  std::string urdf;  ///< as it was, but for the names of what is in `files`
  std::vector<std::pair<std::string, std::string>>
      files;  ///< names beside the URDF file, "meshes/base.stl", and octets
  /// Of each that stays where it is: in which place it is named, or wrong, and why; its link is not seen. Of each that no world reads, too (U0708, docs/urdf-errors.md).
  std::vector<descriptor::Diagnostic> warnings;
};

/// All that <collision> elements name and an arm can read: package://A/B below one of `packages` or a folder above `file`, file://, beside
/// `file`. COLLADA and STL that is a text become binary STL, which arm and world read alike (docs/adr/0218). `text`: of a URDF file that its reader takes.
[[nodiscard]] TakenMeshes take_meshes(const std::filesystem::path& file, std::string_view text,
                                      const descriptor::FileSource& source,
                                      std::span<const std::filesystem::path> packages = {});

}  // namespace hirosco::tools
