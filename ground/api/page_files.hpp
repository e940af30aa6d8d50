// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

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

  /// What a browser says of itself: the Accept-Encoding and If-None-Match of its request, empty where it says nothing.
  struct Browser {
    std::string_view accepts;
    std::string_view has;
  };

  /// `path` as it stands in the request, "/" first. Empty: nothing is there that may be had. The build lays compressed files beside
  /// those of the page (NAME.br, NAME.gz); a file whose name holds the hash of its content is kept for good, every other one is asked
  /// for again and answered with 304 where the browser has it as it is (docs/adr/0100).
  [[nodiscard]] std::optional<HttpResponse> file(const std::string& path, const Browser& browser) const;

 private:
  [[nodiscard]] std::optional<HttpResponse> of_page(const std::string& name, std::string_view accepts) const;
  [[nodiscard]] std::optional<HttpResponse> of_mission(const std::string& name) const;
  /// The names of the mission's files as JSON; "[]" without a folder.
  [[nodiscard]] std::string names_of_mission() const;

  std::filesystem::path page_;
  std::filesystem::path mission_;
};

}  // namespace hirosco::ground
