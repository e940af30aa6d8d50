// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

/// Files that a robot's file names in turn: read by whoever reads that, found by all in the same way (docs/adr/0126).
namespace hirosco::descriptor {

/// Where a mesh lies beside the file that names it: package://A/B is A/B. Nothing: it is nowhere beside it.  Realtime: allocates.
[[nodiscard]] std::optional<std::filesystem::path> mesh_beside(std::string_view named);

/// The files beside `file` that its <mesh> elements name, each once. None: its text is no XML, or names none.  Realtime: allocates.
[[nodiscard]] std::vector<std::filesystem::path> meshes_named(const std::filesystem::path& file, std::string_view text);

}  // namespace hirosco::descriptor
