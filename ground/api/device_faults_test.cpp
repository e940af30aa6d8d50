// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/device_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/played_station.hpp"

namespace hirosco::ground {
namespace {

using ::testing::IsEmpty;
using testing::opening;
using testing::PlayedPage;
using ::testing::SizeIs;

class DeviceFaultsTest : public testing::PlayedStation {
 protected:
  [[nodiscard]] auto keep_answer() {
    return [this](Answered<nlohmann::json> answer) { answers.push_back(std::move(answer)); };
  }
  std::vector<Answered<nlohmann::json>> answers;
  PlayedPage page;
};

TEST_F(DeviceFaultsTest, AreInjectedIntoNothingThatTheMissionDoesNotHave) {
  session.faults().inject({{"device", "../spindle"}, {"line", "unplug"}}, keep_answer());
  session.faults().inject({{"device", "spindle"}, {"line", ""}}, keep_answer());
  session.faults().inject({{"device", "spindle"}, {"line", "unplug\nquit"}}, keep_answer());
  session.faults().inject({{"device", "spindle"}, {"line", std::string(256, 'x')}}, keep_answer());
  ASSERT_THAT(answers, SizeIs(4));
  EXPECT_EQ(answers[0].error().status, 404U);
  for (std::size_t i = 1; i < answers.size(); ++i) EXPECT_EQ(answers[i].error().status, 400U) << i;
  EXPECT_THAT(asked, IsEmpty());
}

TEST_F(DeviceFaultsTest, AreToldOnceThoughTheDeviceTellsOfThemToo) {
  session.pages().opened(page, true);
  session.faults().inject({{"device", "spindle"}, {"line", "unplug"}}, keep_answer());
  ASSERT_THAT(asked, SizeIs(1));
  asked[0].answer("ok");
  ASSERT_THAT(answers, SizeIs(1));
  EXPECT_EQ((*answers[0])["answer"], "ok");
  injected = {{opening, "spindle", "unplug", "ok"}, {opening, "spindle", "plug", "ok"}};
  pass(1s);
  EXPECT_EQ(page.count("fault"), 2U);
  EXPECT_EQ(page.last("fault")["line"], "plug") << "somebody else's";
  EXPECT_THAT(archive->faults({}), SizeIs(2));
  injected = {{opening, "spindle", "unplug", "ok"}};
  pass(1s);
  EXPECT_EQ(page.count("fault"), 3U) << "once is once";
}

TEST_F(DeviceFaultsTest, ThatWereNotInjectedLeadToNoWordOfTheDevice) {
  session.pages().opened(page, true);
  session.faults().inject({{"device", "spindle"}, {"line", "unplug"}}, keep_answer());
  session.faults().inject({{"device", "spindle"}, {"line", "plug"}}, keep_answer());
  asked.at(0).answer(std::nullopt);
  asked.at(1).answer("no such line");
  EXPECT_EQ(answers.at(0).error().status, 503U);
  EXPECT_EQ((*answers.at(1))["answer"], "no such line");
  EXPECT_EQ(page.count("fault"), 1U);
  injected = {{opening, "spindle", "unplug", "ok"}, {opening, "spindle", "plug", "ok"}};
  pass(1s);
  EXPECT_EQ(page.count("fault"), 3U) << "these are somebody else's";
}

}  // namespace
}  // namespace hirosco::ground
