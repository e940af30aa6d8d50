// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/module.hpp"

/// Where the parts of HIROSCO find each other: from the running program's own place, so that an installed tree may be moved.
///   PREFIX/bin, PREFIX/lib/hirosco (modules), PREFIX/share/hirosco (missions, descriptors, page)
/// In a build folder programs and modules stand in bin/, the page in share/hirosco, the rest in the sources above it.
namespace hirosco {

/// The running program; empty when the system does not tell.
[[nodiscard]] std::filesystem::path this_program();

/// The program of this name: beside the running one, then in PATH; empty when nowhere.
[[nodiscard]] std::filesystem::path find_program(std::string_view name);

/// The module of the program of this name, NAME.so: in the folders where the program is looked for, in each also in
/// ../lib/hirosco; empty when nowhere.
[[nodiscard]] std::filesystem::path find_module(std::string_view name);

/// Folders that may hold what comes with HIROSCO, the nearest first: share/hirosco in each folder from that of the running
/// program upwards, and that folder itself.
[[nodiscard]] std::vector<std::filesystem::path> shipped_folders();

/// What a mission writes before the name of a file that comes with HIROSCO: "@hirosco/supervisor/supervisor.xml".
inline constexpr std::string_view shipped_prefix = "@hirosco/";
/// What comes with HIROSCO, by its name in the sources ("supervisor/supervisor.xml"); empty when it is nowhere.
[[nodiscard]] std::filesystem::path find_shipped(std::string_view name);

/// The module of the program of this name. In words why it is not taken; also that there is none.
[[nodiscard]] std::expected<const Module*, std::string> load_module_of(std::string_view program, ModuleKind kind);

/// Loads a module for the life of the process. In words why not: there is none, it is damaged, no module, of another kind,
/// or built against another version. Throws std::bad_alloc when the computer has no memory for it.
[[nodiscard]] std::expected<const Module*, std::string> load_module(const std::filesystem::path& file, ModuleKind kind);

namespace os_detail {
/// Of the backend: false where the file is known to be none that may be loaded, so that its end does not come at an access later.
[[nodiscard]] bool module_is_whole(const std::filesystem::path& file);
/// False where the system is known to have no memory for it.
[[nodiscard]] bool has_room_for_module(const std::filesystem::path& file);
}  // namespace os_detail

}  // namespace hirosco
