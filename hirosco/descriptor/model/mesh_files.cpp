// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/mesh_files.hpp"

#include <algorithm>

#include "hirosco/xml/reader.hpp"

namespace hirosco::descriptor {
namespace {

void collect(const xml::Element& element, const std::filesystem::path& folder,
             std::vector<std::filesystem::path>& found) {
  if (const auto* named = element.find("filename"); element.name == "mesh" && named != nullptr)
    if (const auto mesh = mesh_beside(named->value))
      if (auto path = folder / *mesh; std::ranges::find(found, path) == found.end()) found.push_back(std::move(path));
  for (const xml::Element& child : element.children) collect(child, folder, found);
}

}  // namespace

std::optional<std::filesystem::path> mesh_beside(std::string_view named) {
  constexpr std::string_view package = "package://";
  if (named.starts_with(package)) named.remove_prefix(package.size());
  if (named.find("://") != std::string_view::npos || named.find('\0') != std::string_view::npos) return std::nullopt;
  const auto path = std::filesystem::path{named}.lexically_normal();
  if (path.empty() || path.is_absolute() || *path.begin() == ".." || !path.has_filename()) return std::nullopt;
  return path;
}

std::vector<std::filesystem::path> meshes_named(const std::filesystem::path& file, std::string_view text) {
  std::vector<std::filesystem::path> found;
  if (const auto tree = xml::read_tree(text)) collect(*tree, file.parent_path(), found);
  return found;
}

}  // namespace hirosco::descriptor
