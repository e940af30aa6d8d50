// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/os/sandbox.hpp"

namespace hirosco::supervisor {

/// What runs a script, and what of this computer it needs for that (docs/adr/0210): places, whether there is something or not.
struct Interpreter {
  std::vector<std::string> executable;  ///< what is executed for it, one after the other, and where libraries stand
  std::vector<std::string> readable;  ///< modules
  std::vector<std::string> listable;  ///< folders that are searched for modules
  std::string_view open{};  ///< why it is kept in no sandbox, of static life; empty: it is in one
};

/// Of the program that begins with these octets; nothing: it is no script.
/// \param script Its file, whose modules stand beside it; empty: it runs from memory, and has none there.
/// Looks into folders.  Realtime: blocks, as long as the disk does.
[[nodiscard]] std::optional<Interpreter> interpreter_of(std::string_view begin, const std::filesystem::path& script);

/// Of a program in a file; nothing also where there is none.  Realtime: blocks, as long as the disk does.
[[nodiscard]] std::optional<Interpreter> interpreter_of(const std::filesystem::path& program);

/// Refused calls fail there instead of ending it: an interpreter hears of no signal, and says which line it was.
void let_in(const Interpreter& interpreter, Sandbox& sandbox);

}  // namespace hirosco::supervisor
