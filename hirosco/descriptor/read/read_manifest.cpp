// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/read/detail/mission_parts.hpp"
#include "hirosco/utilities/lower_case.hpp"

/// What a mission may start, line by line as sha256sum writes it (docs/adr/0089).
namespace hirosco::descriptor {
namespace detail {
namespace {

/// Two characters stand between digest and name: a blank, and how the file was read, which here is all the same.
constexpr std::size_t name_at = digest_digits + 2;
constexpr std::size_t max_version = 24;
constexpr std::size_t max_listed = 1000;
constexpr const char* wanted_line =
    "as sha256sum writes it in the folder of the programs: 64 hexadecimal digits, two blanks, a name";

[[nodiscard]] bool is_hexadecimal(char c) noexcept {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

[[nodiscard]] bool has_form(std::string_view line) noexcept {
  return line.size() > name_at && line[digest_digits] == ' ' &&
         (line[digest_digits + 1] == ' ' || line[digest_digits + 1] == '*') &&
         std::ranges::all_of(line.substr(0, digest_digits), is_hexadecimal);
}

/// "arm" or "arm@2".
[[nodiscard]] bool is_listed_name(std::string_view name) noexcept {
  const auto mark = name.find(version_mark);
  if (!is_name(name.substr(0, mark), NameKind::Loose)) return false;
  return mark == std::string_view::npos || is_version(name.substr(mark + 1));
}

void read_line(std::string_view line, int number, Manifest& manifest, Problems& problems) {
  if (manifest.listed.size() >= max_listed)
    return problems.add({number, 1}, "E0361", fmt::format("more than {} executables", max_listed),
                        "a mission has 255 at most; take the lines of others out");
  if (!has_form(line))
    return problems.add({number, 1}, "E0361", in_quotes(line) + " is no line of a manifest", wanted_line,
                        std::max<std::size_t>(line.size(), 1));
  const std::string_view name = line.substr(name_at);
  const Location at{number, static_cast<int>(name_at) + 1};
  if (!is_listed_name(name))
    return problems.add(
        at, "E0361", in_quotes(name) + " is no name of an executable",
        fmt::format("no folder; letters, digits, '_', '-' and '.', and for a version '{}' and at most {} "
                    "of these behind it",
                    version_mark, max_version),
        name.size());
  if (const Listed* before = manifest.find(name); before != nullptr)
    return problems.add(at, "E0362", fmt::format("a second line for {}", in_quotes(name)),
                        fmt::format("the first is line {}: only one can be meant", before->at.line), name.size());
  manifest.listed.push_back({std::string{name}, lower_case(std::string{line.substr(0, digest_digits)}), at});
}

}  // namespace

void read_manifest(const xml::Element& element, MissionDraft& draft, const FileSource& source) {
  Attributes attributes{element, draft.problems};
  no_children(element, draft.problems);
  const auto* path = attributes.required("path");
  if (path == nullptr) return;
  if (const auto wrong = refuse_path(path->value, 0); !wrong.empty())
    return draft.problems.add(*path, "E0314", fmt::format("manifest path {} is not allowed", in_quotes(path->value)),
                              std::string{wrong});
  const auto file = draft.problems.file().parent_path() / path->value;
  if (file.extension() != manifest_extension)
    return draft.problems.add(*path, "E0360", fmt::format("{} is no manifest", in_quotes(path->value)),
                              fmt::format("its name ends with {}", manifest_extension));
  Reading<Manifest> reading = descriptor::read_manifest(file.lexically_normal(), source);
  const bool unreadable = std::ranges::any_of(reading.problems, [](const Diagnostic& d) { return d.code == "E0360"; });
  if (unreadable)
    draft.problems.add(*path, "E0360",
                       fmt::format("manifest {} {}", in_quotes(path->value), reading.problems.front().message),
                       "hirosco manifest MISSION --write makes it; the path is relative to the mission file");
  else if (!reading.problems.empty()) draft.subsystem_problems.push_back(std::move(reading.problems));
  draft.mission.manifest = std::move(reading.value);
}

}  // namespace detail

bool is_version(std::string_view text) noexcept {
  return !text.empty() && text.size() <= detail::max_version && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  });
}

Reading<Manifest> read_manifest(const std::filesystem::path& file, const FileSource& source) {
  detail::Problems problems{file};
  const auto text = source(file);
  if (!text) {
    problems.add({1, 1}, "E0360", text.error().text);
    return {std::nullopt, problems.take(), {}};
  }
  Manifest manifest;
  manifest.file = file;
  std::string_view rest{*text};
  for (int number = 1; !rest.empty() && !problems.full(); ++number) {
    const auto end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    // sha256sum passes over these, too.
    if (!line.empty() && line.front() != '#') detail::read_line(line, number, manifest, problems);
  }
  Reading<Manifest> reading{std::nullopt, problems.take(), {}};
  if (reading.problems.empty()) reading.value = std::move(manifest);
  return reading;
}

}  // namespace hirosco::descriptor
