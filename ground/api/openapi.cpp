// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/openapi.hpp"

#include <array>
#include <string>

#include "ground/api/routes.hpp"
#include "ground/model/json.hpp"
#include "hirosco/utilities/version.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

/// Of a path that takes a token: not understood, no token, not from here or not permitted, too many wrong tokens.
constexpr std::array<unsigned, 4> everywhere{400, 401, 403, 429};

[[nodiscard]] json refers(const char* kind, std::string_view name) {
  return {{"$ref", "#/components/" + std::string{kind} + "/" + std::string{name}}};
}

[[nodiscard]] json schema_of(QueryParameter::Kind kind) {
  using Kind = QueryParameter::Kind;
  json severities = json::array();
  for (const auto& row : EnumTexts<descriptor::Severity>::table) severities.push_back(row.text);
  switch (kind) {
    case Kind::Text: return {{"type", "string"}};
    case Kind::Texts: return {{"type", "array"}, {"items", {{"type", "string"}}}};
    case Kind::Number: return {{"type", "number"}};
    case Kind::Whole: return {{"type", "integer"}};
    case Kind::Severity: return {{"type", "string"}, {"enum", severities}};
  }
  return {};
}

[[nodiscard]] json parameters_of(const Route& route) {
  json list = json::array();
  for (const QueryParameter& known : route.parameters)
    list.push_back({{"name", known.name},
                    {"in", "query"},
                    {"required", known.required},
                    {"description", known.description},
                    {"schema", schema_of(known.kind)}});
  if (route.method == Route::Method::Post)
    list.push_back({{"name", "X-Client"},
                    {"in", "header"},
                    {"required", false},
                    {"description", "`client` of the page's hello message: refused with 409 while it replays"},
                    {"schema", {{"type", "string"}}}});
  return list;
}

[[nodiscard]] json operation_of(const Route& route) {
  json operation{{"summary", route.summary}, {"parameters", parameters_of(route)}};
  json content;
  if (route.answers.empty()) content["text/csv"]["schema"] = {{"type", "string"}};
  else content["application/json"]["schema"] = refers("schemas", route.answers);
  json& responses = operation["responses"];
  responses[std::to_string(route.status)] = {{"description", "done"}, {"content", std::move(content)}};
  for (const unsigned status : everywhere) responses[std::to_string(status)] = refers("responses", "Error");
  for (const unsigned status : route.refusals) responses[std::to_string(status)] = refers("responses", "Error");
  if (!route.body.empty()) {
    operation["requestBody"]["required"] = true;
    operation["requestBody"]["content"]["application/json"]["schema"] = refers("schemas", route.body);
  }
  return operation;
}

}  // namespace

json openapi_document() {
  json document{
      {"openapi", "3.0.3"},
      {"info",
       {{"title", "HIROSCO ground station"},
        {"version", std::string{version}},
        {"license", {{"name", "Apache-2.0"}}},
        {"description", "ground/api/README.md says what holds everywhere, and describes the WebSocket /ws."}}},
      {"servers", json::array({{{"url", "http://127.0.0.1:8080"}}})},
      {"security", json::array({{{"bearer", json::array()}}, {{"token", json::array()}}})}};
  for (const Route& route : routes())
    document["paths"][std::string{route.path}][route.method == Route::Method::Get ? "get" : "post"] =
        operation_of(route);
  json& components = document["components"];
  components["schemas"] = schemas();
  components["securitySchemes"]["bearer"] = {{"type", "http"}, {"scheme", "bearer"}};
  components["securitySchemes"]["token"] = {{"type", "apiKey"}, {"in", "query"}, {"name", "token"}};
  components["responses"]["Error"]["description"] = "not done, and why";
  components["responses"]["Error"]["content"]["application/json"]["schema"] = refers("schemas", "Error");
  return document;
}

}  // namespace hirosco::ground
