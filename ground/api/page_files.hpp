// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "ground/api/application.hpp"

/// The files that a browser gets without a token: those of the page, and below /mission/ those that the mission shows of itself.
/// No path leads out of these two folders, by no name and by no link.
namespace hirosco::ground {

class PageFiles {
 public:
  /// Either may be missing.
  PageFiles(std::filesystem::path page, std::filesystem::path mission)
      : page_{std::move(page)}, mission_{std::move(mission)} {}
  static constexpr std::size_t most_octets = std::size_t{16} << 20;

  /// `path` as it stands in the request, "/" first. Empty: nothing is there that may be had.
  [[nodiscard]] std::optional<HttpResponse> file(const std::string& path, bool zipped) const;

 private:
  [[nodiscard]] std::optional<HttpResponse> of_mission(const std::string& name) const;
  /// The names of the mission's files as JSON; "[]" without a folder.
  [[nodiscard]] std::string names_of_mission() const;

  std::filesystem::path page_;
  std::filesystem::path mission_;
};

}  // namespace hirosco::ground
