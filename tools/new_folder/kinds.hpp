// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

/// `hirosco new`: a folder that builds, tests, simulates and flies as it is (docs/adr/0109).
namespace hirosco::tools {

/// What can be made: the files of templates/NAME, a row each.
struct NewKind {
  const char* name;
  const char* makes;  ///< in words, for help
  bool compiles;      ///< it has code to build before it flies
};
[[nodiscard]] std::span<const NewKind> new_kinds();

/// A name as it is written in each place.
struct NewName {
  std::string lower;  ///< of files, programs and folders: "heat_pipe"
  std::string upper;  ///< of subsystems and missions: "HEAT_PIPE"
  std::string camel;  ///< of types: "HeatPipe"
};
/// From any of the three. In words why not: no letters, digits and '_' that begin with a letter, too long, or taken by the framework
/// or by the build.
[[nodiscard]] std::expected<NewName, std::string> new_name(const std::string& text);

/// The text of a template with this name in it, without the lines of this repository's licence. Names of files, too.
[[nodiscard]] std::string named_text(const std::string& text, const NewName& name);

/// Makes `target`, which must not be there, from all files below `from`. The files made, or in words what is in the way; then nothing
/// is left of it.
[[nodiscard]] std::expected<std::vector<std::filesystem::path>, std::string> make_folder(
    const std::filesystem::path& from, const std::filesystem::path& target, const NewName& name);

}  // namespace hirosco::tools
