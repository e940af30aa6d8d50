// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// What else is written from the words of `--help`, at build time (docs/adr/0109): every command, argument and option is in it.
namespace hirosco::tools {

/// hirosco(1), as man(7) takes it.
[[nodiscard]] std::string man_page(const CLI::App& app);
/// Completion for bash; names of missions it asks of the program itself.
[[nodiscard]] std::string bash_completion(const CLI::App& app);
/// The command that writes these; nobody types it, so help does not show it.
inline constexpr const char* pages_command = "command-pages";

}  // namespace hirosco::tools
