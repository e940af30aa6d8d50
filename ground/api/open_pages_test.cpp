// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/open_pages.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/played_station.hpp"

namespace hirosco::ground {
namespace {

using testing::opening;
using testing::PlayedPage;

class OpenPagesTest : public testing::PlayedStation {
 protected:
  PlayedPage page, other;
};

TEST_F(OpenPagesTest, TellWhoTheyAre) {
  const std::string first = session.pages().opened(page, true, std::string(100, 'a'));
  EXPECT_EQ(session.pages().opened(other, false, "b"), "c2");
  session.pages().received(page, R"({"type":"name","name":"anna"})");
  pass(batch);
  const auto told = other.last("present");
  EXPECT_EQ(told["operators"], 1);
  EXPECT_EQ(told["observers"], 1);
  ASSERT_EQ(told["pages"].size(), 2U);
  EXPECT_EQ(told["pages"][0]["client"], first);
  EXPECT_EQ(told["pages"][0]["name"], "anna");
  EXPECT_EQ(told["pages"][0]["seat"], std::string(Authority::longest_seat, 'a'));
  EXPECT_EQ(told["pages"][1]["seat"], "") << "an observer commands from no seat";
  const auto before = other.count("present");
  pass(1s);
  EXPECT_EQ(other.count("present"), before) << "nothing has changed";
  session.pages().closed(page);
  pass(batch);
  EXPECT_EQ(session.pages().count(), 1U);
  EXPECT_EQ(other.last("present")["operators"], 0);
}

TEST_F(OpenPagesTest, AreListedUpToANumberAndAllCounted) {
  std::vector<PlayedPage> pages(OpenPages::most_present + 3);
  for (PlayedPage& one : pages) session.pages().opened(one, false);
  EXPECT_EQ(session.pages().present()["pages"].size(), OpenPages::most_present);
  EXPECT_EQ(session.pages().present()["observers"], pages.size());
}

TEST_F(OpenPagesTest, AreKnownWhereTheyLookAtThePast) {
  hears(testing::torque_high(catalogue, opening));
  const std::string id = session.pages().opened(page, true);
  EXPECT_FALSE(session.pages().in_replay(id));
  session.pages().received(page, R"({"type":"replay","at":2145916900,"speed":0})");
  EXPECT_TRUE(session.pages().in_replay(id));
  EXPECT_FALSE(session.pages().in_replay("c99"));
  session.pages().received(page, R"({"type":"live"})");
  EXPECT_FALSE(session.pages().in_replay(id));
}

}  // namespace
}  // namespace hirosco::ground
