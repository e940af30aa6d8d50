// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/read.hpp"

/// Files that a file brings along, because it names them: who may read the one may read the others (docs/adr/0144). Which formats do so stands
/// here, a row each, and nowhere else: a reader of missions looks them up, a launcher has the outcome.
namespace hirosco::descriptor {

struct BringingFormat {
  std::string_view extension;  ///< ".urdf"
  /// Files beside `file` that its text names, each once; none: it names none, or is no text of this format.  Realtime: allocates.
  std::vector<std::filesystem::path> (*named)(const std::filesystem::path& file, std::string_view text);
};

/// By the file's name; null: files of its kind name no others.
[[nodiscard]] const BringingFormat* bringing_format_of(const std::filesystem::path& file);

/// What the files that settings of its devices name bring along, each once, where `source` has them: one that it does not have is named by
/// whoever needs it.  Realtime: allocates, and as `source`.
[[nodiscard]] std::vector<std::filesystem::path> brought_files(const SubsystemDescriptor& subsystem,
                                                               const FileSource& source);

}  // namespace hirosco::descriptor
