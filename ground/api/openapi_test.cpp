// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/openapi.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "ground/api/routes.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

void collect_references(const json& part, std::set<std::string>& found) {
  if (part.is_object() && part.contains("$ref")) found.insert(part["$ref"].get<std::string>().substr(1));
  if (part.is_structured())
    for (const json& inner : part) collect_references(inner, found);
}

TEST(OpenApi, EveryRouteIsAnOperationOfTheDocumentAndTheDocumentHasNoOther) {
  const json document = openapi_document();
  std::size_t operations = 0;
  for (const json& methods : document["paths"]) operations += methods.size();
  std::set<std::pair<std::string_view, Route::Method>> known;
  for (const Route& route : routes()) {
    EXPECT_TRUE(known.emplace(route.path, route.method).second) << route.path << " stands twice in the table";
    EXPECT_NE(route.answer, nullptr) << route.path;
    const json& operation = document["paths"][route.path][route.method == Route::Method::Get ? "get" : "post"];
    EXPECT_EQ(operation["summary"], route.summary);
    EXPECT_TRUE(operation["responses"].contains(std::to_string(route.status))) << route.path;
  }
  EXPECT_EQ(operations, routes().size());
}

TEST(OpenApi, EveryReferenceLeadsSomewhereAndEverySchemaIsReferredTo) {
  const json document = openapi_document();
  std::set<std::string> references;
  collect_references(document, references);
  for (const std::string& reference : references)
    EXPECT_TRUE(document.contains(json::json_pointer{reference})) << reference;
  for (const auto& [name, schema] : document["components"]["schemas"].items())
    EXPECT_TRUE(references.contains("/components/schemas/" + name)) << name;
}

std::string judged(const std::string& target) {
  const auto read = read_target(target);
  const Route* route = find_route(read->path, Route::Method::Get);
  return route != nullptr ? senseless(*route, *read) : "no such route";
}

TEST(Routes, JudgeTheirOwnParametersAndNoOthers) {
  EXPECT_EQ(judged("/api/events?limit=many"), "limit: a number is wanted");
  EXPECT_EQ(judged("/api/events?severity=urgent"), "severity: info, low, medium or high is wanted");
  EXPECT_EQ(judged("/api/events?severity=&limit="), "");
  EXPECT_EQ(judged("/api/status?limit=many"), "");
  EXPECT_EQ(judged("/api/export.csv?parameter=A&parameter=B"), "");
  EXPECT_EQ(judged("/api/history?parameter=A&parameter=B"), "parameter: once is enough");
  EXPECT_EQ(judged("/api/status?token=A&token=B"), "token: once is enough");
}

}  // namespace
}  // namespace hirosco::ground
