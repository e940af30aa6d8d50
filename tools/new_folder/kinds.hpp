// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// `hirosco new`: a folder that builds, tests, simulates and flies as it is (docs/adr/0109).
namespace hirosco::tools {

/// What can be made: the files of templates/NAME, a row each.
struct NewKind {
  const char* name;
  const char* makes;  ///< in words, for help
  bool compiles;      ///< it has code to build before it flies
  bool of_urdf{false};  ///< of a robot's file (docs/adr/0115)
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

/// The mission of this template has a part of this name, which carries its ground link: none of one's own can have it.
[[nodiscard]] bool carries_ground_link(const std::filesystem::path& from, const NewName& name);

/// What a folder has besides its name.
struct NewParts {
  std::map<std::string, std::string> words;  ///< by what stands for them in the template: "@joints@"
  std::vector<std::pair<std::string, std::string>> files;  ///< names as in a template, and what is in them, as it is
  std::vector<std::pair<std::string, std::string>> files_as_named{};  ///< the same with names that no word stands in
  std::vector<std::string> without_lines{};  ///< words: lines that begin with one, or with others and it, are left out
  std::vector<std::string> without_files{};  ///< of the template
};

/// Without the lines of this repository's licence: what is made is its author's.
[[nodiscard]] std::string without_licence(const std::string& text);
/// The text of a template with this name and these words in it, without licence. Names of files, too.
[[nodiscard]] std::string named_text(const std::string& text, const NewName& name, const NewParts& parts = {});

/// A file of a template with this ending is not copied: its first line that is no comment names one that comes with HIROSCO.
inline constexpr const char* reference_ending = ".from";
/// The file that a template's `name` refers to; empty when there is none.
[[nodiscard]] std::filesystem::path referred(const std::filesystem::path& from, const std::string& name);

/// Makes `target`, which must not be there, from all files below `from`. The files made, or in words what is in the way; then nothing
/// is left of it.
[[nodiscard]] std::expected<std::vector<std::filesystem::path>, std::string> make_folder(
    const std::filesystem::path& from, const std::filesystem::path& target, const NewName& name,
    const NewParts& parts = {});

}  // namespace hirosco::tools
