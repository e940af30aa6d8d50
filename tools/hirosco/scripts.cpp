// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/scripts.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "hirosco/descriptor/model/setting_files.hpp"
#include "hirosco/pus/script/script.hpp"

namespace hirosco::tools {
namespace {

void add(std::vector<descriptor::Diagnostic>& found, const std::filesystem::path& file, const char* code,
         const std::vector<pus::ScriptProblem>& problems) {
  for (const pus::ScriptProblem& problem : problems)
    found.push_back({.file = file,
                     .at = {problem.line, problem.column},
                     .code = code,
                     .message = problem.message,
                     .hint = problem.hint,
                     .length = problem.length});
}

}  // namespace

std::vector<descriptor::Diagnostic> script_problems(const descriptor::SubsystemDescriptor& owner,
                                                    const descriptor::FileSource& source) {
  std::vector<descriptor::Diagnostic> found;
  for (const descriptor::ScriptFile& script : owner.scripts) {
    const std::filesystem::path file = descriptor::file_of(owner, script.file);
    const auto text = source(file);
    if (!text) {
      found.push_back({.file = owner.file,
                       .at = script.at,
                       .code = "E0422",
                       .message = fmt::format("script '{}': {}: {}", script.name, file.string(), text.error().text),
                       .hint = "the file stands beside the descriptor"});
      continue;
    }
    const pus::ScriptReading reading = pus::read_script(script.name, *text);
    add(found, file, "E0420", reading.problems);
    if (reading.problems.empty()) add(found, file, "E0421", pus::check_script(reading.script, owner));
  }
  return found;
}

}  // namespace hirosco::tools
