// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/page_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

namespace hirosco::ground {
namespace {

constexpr std::string_view mission_prefix = "/mission/";
constexpr std::size_t most_names = 1000;

/// By the extension; none for one that a page has no use for.
[[nodiscard]] const char* type_of(const std::filesystem::path& file) {
  constexpr std::array<std::pair<std::string_view, const char*>, 14> types{{{".html", "text/html; charset=utf-8"},
                                                                            {".js", "text/javascript; charset=utf-8"},
                                                                            {".mjs", "text/javascript; charset=utf-8"},
                                                                            {".css", "text/css; charset=utf-8"},
                                                                            {".json", "application/json"},
                                                                            {".svg", "image/svg+xml"},
                                                                            {".png", "image/png"},
                                                                            {".ico", "image/x-icon"},
                                                                            {".woff2", "font/woff2"},
                                                                            {".urdf", "application/xml"},
                                                                            {".stl", "model/stl"},
                                                                            {".glb", "model/gltf-binary"},
                                                                            {".txt", "text/plain; charset=utf-8"},
                                                                            {".map", "application/json"}}};
  const std::string extension = file.extension().string();
  const auto found = std::ranges::find(types, extension, &std::pair<std::string_view, const char*>::first);
  return found != types.end() ? found->second : nullptr;
}

constexpr const char* plain_page = R"(<!doctype html><html lang="en"><meta charset="utf-8"><title>HIROSCO</title>
<h1>HIROSCO ground station</h1>
<p>The gateway runs, but its page is not built: install npm and node (18 or later), configure the build again and build
the target hirosco_ground_page. The API works without it; see ground/api/README.md.</p></html>
)";

[[nodiscard]] std::optional<std::string> content_of(const std::filesystem::path& file) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed) ||
      std::filesystem::file_size(file, failed) > PageFiles::most_octets)
    return std::nullopt;
  std::ifstream stream{file, std::ios::binary};
  std::string content{std::istreambuf_iterator<char>{stream}, {}};
  return stream ? std::optional{std::move(content)} : std::nullopt;
}

/// A path of plain names: nothing that leads out of the folder or to a hidden file.
[[nodiscard]] bool plain_path(const std::string& path) {
  if (!path.starts_with('/')) return false;
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.' || c == '/';
  };
  return std::ranges::all_of(path, plain) && path.find("/.") == std::string::npos &&
         path.find("//") == std::string::npos;
}

/// Whether the file stands in the folder when all links are followed.
[[nodiscard]] bool within(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::error_code failed;
  const auto top = std::filesystem::canonical(folder, failed);
  if (failed) return false;
  const auto there = std::filesystem::canonical(file, failed);
  if (failed) return false;
  return std::ranges::mismatch(top, there).in1 == top.end();
}

}  // namespace

std::optional<HttpResponse> PageFiles::file(const std::string& path, bool zipped) const {
  if (!plain_path(path)) return std::nullopt;
  if (path.starts_with(mission_prefix)) return of_mission(path.substr(mission_prefix.size()));
  const std::string wanted = path == "/" ? "/index.html" : path;
  const std::filesystem::path file = page_ / wanted.substr(1);
  HttpResponse response;
  const char* type = type_of(file);
  response.type = type != nullptr ? type : "application/octet-stream";
  auto content = zipped ? content_of(file.string() + ".gz") : std::nullopt;
  if (content) response.headers.emplace_back("Content-Encoding", "gzip");
  if (!content) content = content_of(file);
  if (!content && wanted == "/index.html") content = plain_page;
  if (!content) return std::nullopt;
  response.body = std::move(*content);
  return response;
}

std::optional<HttpResponse> PageFiles::of_mission(const std::string& name) const {
  HttpResponse response;
  if (name == "index.json") {
    response.body = names_of_mission();
    return response;
  }
  const std::filesystem::path file = mission_ / name;
  const char* type = type_of(file);
  if (mission_.empty() || type == nullptr || !within(mission_, file)) return std::nullopt;
  auto content = content_of(file);
  if (!content) return std::nullopt;
  response.type = type;
  response.body = std::move(*content);
  return response;
}

std::string PageFiles::names_of_mission() const {
  std::vector<std::string> names;
  std::error_code failed;
  std::filesystem::directory_iterator at{mission_, failed};
  for (; !failed && at != std::filesystem::directory_iterator{} && names.size() < most_names; at.increment(failed)) {
    const std::string name = at->path().filename();
    if (plain_path("/" + name) && type_of(at->path()) != nullptr && at->is_regular_file(failed)) names.push_back(name);
  }
  std::ranges::sort(names);
  return nlohmann::json(names).dump();
}

}  // namespace hirosco::ground
