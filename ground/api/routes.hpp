// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "ground/api/mission_json.hpp"
#include "ground/api/responses.hpp"
#include "ground/api/session.hpp"
#include "ground/api/target.hpp"

/// Every path of the API: a row here is all that dispatch and the OpenAPI document know of it.
namespace hirosco::ground {

/// One parameter in the address. An empty one is as good as none.
struct QueryParameter {
  enum class Kind : std::uint8_t { Text, Texts, Number, Whole, Severity };
  std::string_view name;
  Kind kind{Kind::Text};
  std::string_view description;
  bool required{false};
};

/// What an answer is made of.
struct Question {
  Session& session;
  const Target& target;
  const nlohmann::json& body;        ///< of a POST, an object
  std::span<const Transition> transitions;
  const FaultTexts& faults;
};
using Respond = std::function<void(HttpResponse)>;

struct Route {
  enum class Method : std::uint8_t { Get, Post };
  std::string_view path;
  Method method{Method::Get};
  std::string_view summary;
  std::span<const QueryParameter> parameters;
  std::string_view body;             ///< schema of what is posted, by name; "" = nothing
  unsigned status{200};              ///< when it is done
  std::string_view answers;          ///< schema of that, by name; "" = text/csv
  std::span<const unsigned> refusals;  ///< besides those that every path has
  /// Answers now or later, once.
  void (*answer)(const Question&, const Respond&){nullptr};
};

[[nodiscard]] std::span<const Route> routes();
[[nodiscard]] const Route* find_route(std::string_view path, Route::Method method);
/// What is wrong with the parameters of a request to it, in words; empty: nothing.
[[nodiscard]] std::string senseless(const Route& route, const Target& target);

}  // namespace hirosco::ground
