// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/responses.hpp"

#include <algorithm>

#include "ground/model/json.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

/// No script but ours, nothing from anywhere else, in nobody's frame.
constexpr const char* policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; "
    "connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

}  // namespace

HttpResponse with_headers(HttpResponse response) {
  response.headers.emplace_back("Content-Security-Policy", policy);
  response.headers.emplace_back("X-Content-Type-Options", "nosniff");
  response.headers.emplace_back("Referrer-Policy", "no-referrer");
  response.headers.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
  response.headers.emplace_back("Cross-Origin-Opener-Policy", "same-origin");
  const auto says_how_long = [](const auto& one) { return one.first == "Cache-Control"; };
  if (std::ranges::none_of(response.headers, says_how_long)) response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

HttpResponse answer(const json& content, unsigned status) {
  return with_headers({.status = status, .body = to_string(content), .headers = {}});
}

HttpResponse error(unsigned status, const std::string& text) { return answer({{"error", text}}, status); }

HttpResponse outcome(const Answered<json>& result, unsigned status) {
  return result ? answer(*result, status) : error(result.error().status, result.error().text);
}

}  // namespace hirosco::ground
