// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string_view>

#include "hirosco/utilities/os/installation.hpp"

namespace hirosco::tools {

namespace fs = std::filesystem;

namespace {

constexpr std::array kinds{
    NewKind{"subsystem", "a subsystem with its test, and a mission that flies it", true},
    NewKind{"device", "a simulated device, the subsystem that commands it, and a mission that flies both", true},
    NewKind{"mission", "a mission made of what is installed, with a page of its own, without code", false},
    NewKind{"robot", "an arm of a URDF file in a world of MuJoCo's, shown by the page, without code", false, true},
};

/// As templates have it, in the order of NewName.
constexpr std::string_view lower_word = "newpart", upper_word = "NEWPART", camel_word = "NewPart";
constexpr std::size_t longest_name = 24;
/// Other parts of every mission, and targets that a build has already.
constexpr std::array taken{"supervisor", "ground",  "all",   "test",    "install", "clean",  "help",
                           "package",    "hirosco", "build", "rebuild", "edit",    "codegen"};

[[nodiscard]] bool is_upper(char letter) { return std::isupper(static_cast<unsigned char>(letter)) != 0; }
[[nodiscard]] char lower(char letter) { return static_cast<char>(std::tolower(static_cast<unsigned char>(letter))); }
[[nodiscard]] char upper(char letter) { return static_cast<char>(std::toupper(static_cast<unsigned char>(letter))); }

void replace_all(std::string& text, std::string_view word, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += by.size())
    text.replace(at, word.size(), by);
}

[[nodiscard]] std::string read(const fs::path& file) {
  std::ifstream text{file, std::ios::binary};
  return {std::istreambuf_iterator<char>{text}, {}};
}

/// Whether one of the words with which it begins is one of these: a line may be of two things at once.
[[nodiscard]] bool is_left_out(std::string_view line, const std::vector<std::string>& words) {
  while (line.starts_with('@')) {
    const std::size_t end = line.find('@', 1);
    if (end == std::string_view::npos) return false;
    if (std::ranges::find(words, line.substr(0, end + 1)) != words.end()) return true;
    line.remove_prefix(end + 1);
  }
  return false;
}

[[nodiscard]] std::string without_lines(const std::string& text, const std::vector<std::string>& words) {
  if (words.empty()) return text;
  std::string made;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string_view line{text.data() + begin, end - begin};
    if (!is_left_out(line, words)) made += line;
    begin = end;
  }
  return made;
}

/// Empty: all are made.
[[nodiscard]] std::string make_files(const fs::path& from, const fs::path& target, const NewName& name,
                                     const NewParts& parts, std::vector<fs::path>& made) {
  std::error_code failed;
  const auto make = [&](const std::string& named, const std::string& text) {
    const fs::path file = target / named;
    fs::create_directories(file.parent_path(), failed);
    std::ofstream written{file, std::ios::binary};
    written << text;
    made.push_back(file);
    return static_cast<bool>(written.flush());
  };
  for (const auto& entry : fs::recursive_directory_iterator{from, failed}) {
    if (!entry.is_regular_file(failed) || entry.path().extension() == reference_ending) continue;
    const std::string as_in_template = fs::relative(entry.path(), from, failed).string();
    if (std::ranges::find(parts.without_files, as_in_template) != parts.without_files.end()) continue;
    if (!make(named_text(as_in_template, name), named_text(read(entry.path()), name, parts)))
      return fmt::format("{} cannot be written", made.back().string());
  }
  for (const auto& [as_in_template, text] : parts.files)
    if (!make(named_text(as_in_template, name), text)) return fmt::format("{} cannot be written", made.back().string());
  for (const auto& [named, text] : parts.files_as_named)
    if (!make(named, text)) return fmt::format("{} cannot be written", made.back().string());
  if (failed) return fmt::format("{}: {}", from.string(), failed.message());
  if (made.empty()) return fmt::format("there is nothing in {}", from.string());
  std::ranges::sort(made);
  return {};
}

}  // namespace

std::span<const NewKind> new_kinds() { return kinds; }

std::expected<NewName, std::string> new_name(const std::string& text) {
  constexpr std::string_view rule = "letters, digits and single '_', first a letter, 24 at most";
  NewName name;
  bool begins = true;  // of a word
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char letter = text[i] == '-' ? '_' : text[i];
    if (letter != '_' && std::isalnum(static_cast<unsigned char>(letter)) == 0)
      return std::unexpected{std::string{rule}};
    if (letter == '_' && begins) return std::unexpected{std::string{rule}};
    const bool follows_lower = i > 0 && std::islower(static_cast<unsigned char>(text[i - 1])) != 0;
    if (is_upper(letter) && follows_lower) {
      name.lower += '_';
      begins = true;
    }
    if (letter == '_') name.lower += '_';
    else {
      name.lower += lower(letter);
      name.camel += begins ? upper(letter) : lower(letter);
    }
    begins = letter == '_';
  }
  if (name.lower.empty() || begins || name.lower.size() > longest_name ||
      std::isalpha(static_cast<unsigned char>(name.lower[0])) == 0)
    return std::unexpected{std::string{rule}};
  if (std::ranges::find(taken, name.lower) != taken.end())
    return std::unexpected{fmt::format("'{}' is a name of the framework or of its build", name.lower)};
  std::ranges::transform(name.lower, std::back_inserter(name.upper), upper);
  return name;
}

bool carries_ground_link(const fs::path& from, const NewName& name) {
  return read(from / "mission.xml").find("<Ground subsystem=\"" + name.upper + '"') != std::string::npos;
}

std::string without_licence(const std::string& text) {
  std::string made;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string_view line{text.data() + begin, end - begin};
    if (line.find("SP"
                  "DX-") == std::string_view::npos)
      made += line;
    begin = end;
  }
  if (made.size() < text.size() && made.starts_with('\n')) made.erase(0, 1);
  return made;
}

std::string named_text(const std::string& text, const NewName& name, const NewParts& parts) {
  std::string made = without_lines(without_licence(text), parts.without_lines);
  replace_all(made, lower_word, name.lower);
  replace_all(made, upper_word, name.upper);
  replace_all(made, camel_word, name.camel);
  for (const auto& [word, by] : parts.words) replace_all(made, word, by);
  return made;
}

fs::path referred(const fs::path& from, const std::string& name) {
  std::ifstream lines{from / (name + reference_ending)};
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && !line.starts_with('#')) return find_shipped(line);
  return {};
}

std::expected<std::vector<fs::path>, std::string> make_folder(const fs::path& from, const fs::path& target,
                                                              const NewName& name, const NewParts& parts) {
  std::error_code failed;
  if (fs::exists(fs::symlink_status(target, failed)))
    return std::unexpected{fmt::format("{} is there already", target.string())};
  if (!fs::create_directories(target, failed))
    return std::unexpected{fmt::format("{}: {}", target.string(), failed.message())};
  std::vector<fs::path> made;
  if (std::string why_not = make_files(from, target, name, parts, made); !why_not.empty()) {
    fs::remove_all(target, failed);
    return std::unexpected{std::move(why_not)};
  }
  return made;
}

}  // namespace hirosco::tools
