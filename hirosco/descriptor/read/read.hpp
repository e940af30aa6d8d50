// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::descriptor {

enum class Grade : std::uint8_t {
  Error,    ///< the descriptor is not taken
  Warning,  ///< it is, but somebody should know
};

/// One problem of a descriptor, where it is and what to do about it.
struct Diagnostic {
  std::filesystem::path file;
  Location at;
  std::string code;                  ///< "E0104": stable, explained in docs/descriptor-errors.md
  std::string message;               ///< "unknown parameter type 'DUBLE'"
  std::string hint;                  ///< "did you mean 'DOUBLE'?"; may be empty
  std::size_t length{1};             ///< characters to underline
  Grade grade{Grade::Error};
};

/// Reads whole files; given from outside so that reading is testable without a file system.
/// Returns the octets, or why there is no such (regular, readable, at most 4 MiB) file: "is a folder".
using FileSource = std::function<Result<std::string>(const std::filesystem::path&)>;
[[nodiscard]] FileSource file_system();

template <class T>
struct Reading {
  std::optional<T> value;            ///< present only when `problems` is empty
  std::vector<Diagnostic> problems;  ///< all errors, in file order
  std::vector<Diagnostic> warnings;  ///< all of them, in file order
};

/// Reads and checks a subsystem descriptor. `name` is used in the diagnostics.  Realtime: allocates.
[[nodiscard]] Reading<SubsystemDescriptor> read_subsystem(const std::filesystem::path& file, const FileSource& source);
/// Reads and checks a mission with every subsystem it names (paths relative to the mission file), and looks up what files of their settings
/// bring along.  Realtime: allocates.
[[nodiscard]] Reading<Mission> read_mission(const std::filesystem::path& file, const FileSource& source);

/// Another text of the descriptor of a subsystem that flies, with `changes` of it applied as its process was told them when it started
/// (changes_of()); whom it commands stays as resolved.  Realtime: allocates.
[[nodiscard]] Reading<SubsystemDescriptor> read_again(const SubsystemDescriptor& flown, std::string_view text,
                                                      const std::vector<std::pair<std::string, std::string>>& changes);
/// The mission that flies with another text of one of its files, judged as a whole: the others are as they were when it was read. What files of
/// other formats bring along is looked up in `disk` anew (brought_files.hpp).  Realtime: allocates, and as `disk`.
[[nodiscard]] Reading<Mission> read_again(const Mission& flown, const std::filesystem::path& file, std::string text,
                                          const FileSource& disk);

/// Reads the manifest of a mission (docs/adr/0089).  Realtime: allocates.
[[nodiscard]] Reading<Manifest> read_manifest(const std::filesystem::path& file, const FileSource& source);
inline constexpr std::string_view manifest_extension = ".sha256";
/// What may stand behind the '@' of a name in it.
[[nodiscard]] bool is_version(std::string_view text) noexcept;

/// "NAME=12:FILE", as a launched subsystem is told whom it commands; and the reverse, into `subsystem`. NotFound: it commands
/// none of that name, or who has the file has no such function; InvalidArgument: not of this form.
[[nodiscard]] std::string to_string(const Commands& commands);
[[nodiscard]] Result<> apply_commands(SubsystemDescriptor& subsystem, std::string_view text, const FileSource& source);
/// The same of whom it hears.
[[nodiscard]] std::string to_string(const Subscribes& subscribes);
[[nodiscard]] Result<> apply_subscribes(SubsystemDescriptor& subsystem, std::string_view text,
                                        const FileSource& source);
/// Either of them, by its word (needs_other()).
[[nodiscard]] Result<> apply_other(SubsystemDescriptor& subsystem, std::string_view word, std::string_view text,
                                   const FileSource& source);

/// file:line:col: error: E0104: …, the source line, a caret and the hint. Without the line where `source` is empty or has the file no more.
[[nodiscard]] std::string render(const Diagnostic& problem, const FileSource& source, bool colour);

}  // namespace hirosco::descriptor
