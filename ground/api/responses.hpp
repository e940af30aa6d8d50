// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ground/api/application.hpp"
#include "ground/model/answered.hpp"

/// Answers of the API, each with the headers that keep a page to itself.
namespace hirosco::ground {

[[nodiscard]] HttpResponse with_headers(HttpResponse response);
[[nodiscard]] HttpResponse answer(const nlohmann::json& content, unsigned status = 200);
[[nodiscard]] HttpResponse error(unsigned status, const std::string& text);
[[nodiscard]] HttpResponse outcome(const Answered<nlohmann::json>& result, unsigned status = 200);

}  // namespace hirosco::ground
