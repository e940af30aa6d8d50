// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/responses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hirosco::ground {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

/// All that stands under a name.
std::vector<std::string> headers_of(const HttpResponse& response, const std::string& name) {
  std::vector<std::string> found;
  for (const auto& [key, value] : response.headers)
    if (key == name) found.push_back(value);
  return found;
}

TEST(AResponse, KeepsAPageToItself) {
  const HttpResponse response = answer(nlohmann::json::object());
  const auto policy = headers_of(response, "Content-Security-Policy");
  ASSERT_THAT(policy, SizeIs(1));
  EXPECT_THAT(policy[0], HasSubstr("default-src 'none'"));
  EXPECT_THAT(policy[0], HasSubstr("script-src 'self';"));
  EXPECT_THAT(policy[0], HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(policy[0], Not(HasSubstr("unsafe")));
  EXPECT_THAT(headers_of(response, "X-Content-Type-Options"), ElementsAre("nosniff"));
  EXPECT_THAT(headers_of(response, "Referrer-Policy"), ElementsAre("no-referrer"));
  EXPECT_THAT(headers_of(response, "Cross-Origin-Resource-Policy"), ElementsAre("same-origin"));
  EXPECT_THAT(headers_of(response, "Cross-Origin-Opener-Policy"), ElementsAre("same-origin"));
}

TEST(AResponse, IsKeptByNobodyUnlessItSaysHowLong) {
  EXPECT_THAT(headers_of(answer({}), "Cache-Control"), ElementsAre("no-store"));
  HttpResponse file;
  file.headers.emplace_back("Cache-Control", "max-age=60");
  EXPECT_THAT(headers_of(with_headers(file), "Cache-Control"), ElementsAre("max-age=60"));
}

TEST(AResponse, IsJsonWhateverOctetsANameHas) {
  const HttpResponse response = answer({{"name", "\xFF<script>"}}, 202);
  EXPECT_EQ(response.status, 202U);
  EXPECT_EQ(response.type, "application/json");
  EXPECT_EQ(nlohmann::json::parse(response.body)["name"], "\xEF\xBF\xBD<script>");
}

TEST(AResponse, SaysWhyARequestWasNotDoneWithItsStatus) {
  EXPECT_EQ(error(404, "nothing is there").status, 404U);
  EXPECT_EQ(error(404, "nothing is there").body, R"({"error":"nothing is there"})");
  EXPECT_EQ(outcome(refuse(409, "not now"), 202).status, 409U);
  EXPECT_EQ(outcome(refuse(409, "not now"), 202).body, R"({"error":"not now"})");
  EXPECT_EQ(outcome(nlohmann::json{{"id", 1}}, 202).status, 202U);
  EXPECT_EQ(outcome(nlohmann::json{{"id", 1}}).body, R"({"id":1})");
}

}  // namespace
}  // namespace hirosco::ground
