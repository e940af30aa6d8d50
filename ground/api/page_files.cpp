// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/page_files.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
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

/// The best first.
constexpr std::array<std::pair<const char*, const char*>, 2> encodings{{{"br", ".br"}, {"gzip", ".gz"}}};
constexpr unsigned not_modified = 304;

/// Whether the bundler put the hash of the content into the name: NAME-XXXXXXXX.ENDING.
[[nodiscard]] bool named_by_content(const std::string& name) {
  constexpr std::size_t hash_length = 8;
  const std::size_t dash = name.rfind('-');
  const std::size_t dot = dash == std::string::npos ? dash : name.find('.', dash);
  if (dot == std::string::npos || dot - dash - 1 != hash_length) return false;
  const auto of_hash = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); };
  return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dash) + 1,
                     name.begin() + static_cast<std::ptrdiff_t>(dot), of_hash);
}

/// FNV-1a over type, encoding and content: another file has another tag, and so has the same one compressed otherwise.
[[nodiscard]] std::string tag_of(const HttpResponse& response) {
  std::uint64_t hash = 14695981039346656037U;
  const auto take = [&hash](std::string_view text) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  };
  take(response.type);
  for (const auto& [name, value] : response.headers) take(value);
  take(response.body);
  std::string digits;
  for (int shift = 60; shift >= 0; shift -= 4)
    digits += "0123456789abcdef"[(hash >> static_cast<unsigned>(shift)) & 15U];
  // Weak: the shell may compress what is the same file.
  return "W/\"" + digits + '"';
}

}  // namespace

std::optional<HttpResponse> PageFiles::file(const std::string& path, const Browser& browser) const {
  if (!plain_path(path)) return std::nullopt;
  auto response = path.starts_with(mission_prefix)
                      ? of_mission(path.substr(mission_prefix.size()))
                      : of_page(path == "/" ? "index.html" : path.substr(1), browser.accepts);
  if (!response) return std::nullopt;
  const std::string tag = tag_of(*response);
  response->headers.emplace_back("ETag", tag);
  if (browser.has.find(tag) != std::string_view::npos) {
    response->status = not_modified;
    response->body.clear();
  }
  return response;
}

std::optional<HttpResponse> PageFiles::of_page(const std::string& name, std::string_view accepts) const {
  const std::filesystem::path file = page_ / name;
  HttpResponse response;
  const char* type = type_of(file);
  response.type = type != nullptr ? type : "application/octet-stream";
  response.headers.emplace_back("Cache-Control",
                                named_by_content(name) ? "public, max-age=31536000, immutable" : "no-cache");
  response.headers.emplace_back("Vary", "Accept-Encoding");
  std::optional<std::string> content;
  for (const auto& [encoding, ending] : encodings) {
    if (content || accepts.find(encoding) == std::string_view::npos) continue;
    content = content_of(file.string() + ending);
    if (content) response.headers.emplace_back("Content-Encoding", encoding);
  }
  if (!content) content = content_of(file);
  if (!content && name == "index.html") content = plain_page;
  if (!content) return std::nullopt;
  response.body = std::move(*content);
  return response;
}

std::optional<HttpResponse> PageFiles::of_mission(const std::string& name) const {
  HttpResponse response;
  response.headers.emplace_back("Cache-Control", "no-cache");
  if (name == "index.json") {
    response.body = names_of_mission();
    return response;
  }
  const std::filesystem::path file = mission_ / name;
  const char* type = type_of(file);
  if (type == nullptr) return std::nullopt;
  std::optional<std::string> content;
  if (!mission_.empty() && within(mission_, file)) content = content_of(file);
  // What every page asks for first is always there: one that had to look for it would have its robot later.
  if (!content && name == "scene.json") content = "null";
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
