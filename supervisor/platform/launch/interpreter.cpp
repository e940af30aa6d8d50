// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/interpreter.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace hirosco::supervisor {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view script_mark = "#!", python = "python";
/// As much of a program as the kernel looks at.
constexpr std::size_t begin_octets = 256;

/// By which variable whoever flies names folders of modules to an interpreter.
struct ModuleVariable {
  std::string_view interpreter;
  const char* variable;
};
constexpr std::array module_variables{ModuleVariable{python, "PYTHONPATH"}, ModuleVariable{"perl", "PERL5LIB"},
                                      ModuleVariable{"ruby", "RUBYLIB"}};

[[nodiscard]] std::string_view text_of(const char* variable) noexcept {
  const char* const text = std::getenv(variable);
  return text != nullptr ? text : "";
}

/// Up to the next of these; what is left begins behind it.
[[nodiscard]] std::string_view part(std::string_view& rest, std::string_view separators) noexcept {
  const auto end = rest.find_first_of(separators);
  const std::string_view first = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  return first;
}

[[nodiscard]] std::string_view next_word(std::string_view& rest) noexcept {
  std::string_view word;
  while (word.empty() && !rest.empty()) word = part(rest, " \t");
  return word;
}

/// The program that env is told to start; nothing: it is told more than is read here.
[[nodiscard]] std::optional<std::string_view> started_by_env(std::string_view words) noexcept {
  std::string_view word = next_word(words);
  if (word.starts_with("-S")) word = word.size() > 2 ? word.substr(2) : next_word(words);
  while (word.contains('=') && !word.starts_with('-') && !word.starts_with("PATH=")) word = next_word(words);
  if (word.empty() || word.starts_with('-') || word.find_first_of("=\"'\\$") != std::string_view::npos)
    return std::nullopt;
  return word;
}

/// As execvp() finds it.
[[nodiscard]] fs::path in_path(std::string_view name) {
  if (name.contains('/')) return name;
  std::string_view folders = text_of("PATH");
  std::error_code failed;
  while (!folders.empty()) {
    const std::string_view folder = part(folders, ":");
    fs::path candidate = fs::path{folder.empty() ? "." : folder} / name;
    if (fs::is_regular_file(candidate, failed) && ::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return {};
}

/// Empty where nobody knows: it is from here, and this folder is gone.
[[nodiscard]] fs::path whole(const fs::path& place) {
  std::error_code failed;
  return fs::absolute(place, failed);
}

[[nodiscard]] std::string begin_of(const fs::path& file) {
  std::error_code failed;
  std::string begin;
  if (!fs::is_regular_file(file, failed)) return begin;
  begin.resize(begin_octets);
  std::ifstream octets{file, std::ios::binary};
  octets.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(octets.gcount()));
  return begin;
}

void add(const fs::path& place, std::vector<std::string>& places) {
  if (std::ranges::find(places, place.string()) == places.end()) places.push_back(place.string());
}

/// In the order of their names.
[[nodiscard]] std::vector<fs::directory_entry> entries_of(const fs::path& folder) {
  std::vector<fs::directory_entry> found;
  std::error_code failed;
  for (fs::directory_iterator next{folder, failed}; !failed && next != fs::directory_iterator{}; next.increment(failed))
    found.push_back(*next);
  std::ranges::sort(found, {}, [](const fs::directory_entry& entry) { return entry.path(); });
  return found;
}

/// "python" of "python3.11".
[[nodiscard]] std::string stem_of(const fs::path& program) {
  std::string name = program.filename().string();
  name.erase(std::ranges::find_if(name, [](unsigned char c) { return std::isalpha(c) == 0; }), name.end());
  return name;
}

/// Folders in this one that are called as an interpreter, in whatever version: python3, python3.11.
void add_called(const std::string& stem, const fs::path& folder, std::vector<std::string>& places) {
  std::error_code failed;
  for (const fs::directory_entry& entry : entries_of(folder))
    if (!stem.empty() && stem_of(entry.path()) == stem && entry.is_directory(failed)) add(entry.path(), places);
}

/// What was installed with it, and what whoever flies has installed or named for it.
void add_installed(const fs::path& program, const fs::path& real, Interpreter& made) {
  const std::string stem = stem_of(real);
  // As it is named, too: of an environment of its own the link alone stands there.
  for (const fs::path& named : {program, real}) {
    const fs::path prefix = named.parent_path().parent_path();
    if (named.parent_path().filename() != "bin" && named.parent_path().filename() != "sbin") continue;
    for (const char* library : {"lib", "lib64"}) add(prefix / library, made.executable);
    add(prefix / "pyvenv.cfg", made.readable);
    add_called(stem, prefix / "share", made.readable);
  }
  // Beside "/usr/local/lib", which every sandbox has.
  add_called(stem, "/usr/local/share", made.readable);
  add_called(stem, "/etc", made.readable);
  if (const auto home = text_of("HOME"); !home.empty()) add_called(stem, fs::path{home} / ".local/lib", made.readable);
  for (const auto& [interpreter, variable] : module_variables)
    if (interpreter == stem)
      for (std::string_view folders = text_of(variable); !folders.empty();)
        if (const auto folder = part(folders, ":"); !folder.empty()) add(whole(folder), made.readable);
}

/// Files beside it that are called as its modules are, and packages of Python. Not all that stands there: keys may, too. Their folder is listed by
/// Python alone, and by a script that has some.
void add_beside(const fs::path& script, bool of_python, Interpreter& made) {
  std::error_code failed;
  const fs::path own = fs::canonical(script, failed), folder = own.parent_path(), extension = script.extension();
  if (failed) return;
  const auto is_module = [&](const fs::path& file) {
    return (!extension.empty() && file.extension() == extension) ||
           (of_python && (file.extension() == ".py" || file.extension() == ".so"));
  };
  for (const fs::directory_entry& entry : entries_of(folder)) {
    const bool package = of_python && (entry.path().filename() == "__pycache__" ||
                                       fs::is_regular_file(entry.path() / "__init__.py", failed));
    const bool another = is_module(entry.path()) && entry.path() != own && entry.is_regular_file(failed);
    if (!package && !another) continue;
    add(entry.path(), made.readable);
    if (of_python) add(folder, made.listable);
  }
}

}  // namespace

std::optional<Interpreter> interpreter_of(std::string_view begin, const fs::path& script) {
  if (!begin.starts_with(script_mark)) return std::nullopt;
  begin = begin.substr(script_mark.size(), begin_octets - script_mark.size());
  std::string_view line = part(begin, "\n");
  Interpreter made;
  fs::path program{next_word(line)};
  if (program.filename() == "env") {
    add(whole(program), made.executable);
    const auto started = started_by_env(line);
    if (!started) {
      made.open = "its first line tells env more than is read here";
      return made;
    }
    program = in_path(*started);
  }
  if (program.empty()) return made;  // and nobody starts it
  program = whole(program);
  // It executes others, of which nobody knows.
  if (begin_of(program).starts_with(script_mark)) {
    made.open = "its interpreter is a script, too";
    return made;
  }
  add(program, made.executable);
  std::error_code failed;
  const fs::path real = fs::canonical(program, failed);
  if (failed) return made;
  add_installed(program, real, made);
  if (!script.empty()) add_beside(script, stem_of(real) == python, made);
  return made;
}

std::optional<Interpreter> interpreter_of(const fs::path& program) {
  return interpreter_of(begin_of(program), program);
}

void let_in(const Interpreter& interpreter, Sandbox& sandbox) {
  const auto append = [](const std::vector<std::string>& from, std::vector<std::string>& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(interpreter.executable, sandbox.executable);
  append(interpreter.readable, sandbox.readable);
  append(interpreter.listable, sandbox.listable);
  sandbox.refusal = CallRefusal::Error;
}

}  // namespace hirosco::supervisor
