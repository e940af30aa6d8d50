// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/safe_answer.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

/// What was said on `safe.socket`, and what it is taken for: nobody but a whole answer says that all have stopped.
namespace hirosco::supervisor {
namespace {

using Stop = SafeAnswer::Stop;
using Messages = std::vector<std::string>;

SafeAnswer heard(const Messages& messages) {
  SafeAnswer answer;
  for (const std::string& message : messages) answer.take(message);
  return answer;
}

Messages whole(const std::vector<bool>& stopped) {
  Messages messages;
  for (const bool one : stopped) messages.push_back(safe_line(one, "MOTOR and what is said of it"));
  messages.push_back(safe_last_line(stopped.size()));
  return messages;
}

TEST(SafeAnswer, SaysThatAllHaveStoppedWhereEachDidAndNowhereElse) {
  EXPECT_EQ(heard({}).stop(), Stop::Nobody);
  for (unsigned stopped = 0; stopped < 1U << 5; ++stopped)
    for (std::size_t members = 0; members <= 5; ++members) {
      std::vector<bool> each;
      bool all = true;
      for (std::size_t i = 0; i < members; ++i) {
        each.push_back((stopped >> i & 1U) != 0);
        all = all && each.back();
      }
      const SafeAnswer answer = heard(whole(each));
      EXPECT_EQ(answer.stop(), all ? Stop::All : Stop::NotAll) << stopped << " of " << members;
      EXPECT_EQ(answer.why_not_whole(), "");
    }
}

TEST(SafeAnswer, OfWhichAnyMessageIsMissingSaysThatNotAllHaveStopped) {
  const Messages all = whole({true, true, true});
  for (std::size_t begun = 1; begun < all.size(); ++begun) {
    const SafeAnswer answer = heard({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(begun)});
    EXPECT_EQ(answer.stop(), Stop::NotAll) << "cut off behind " << begun;
    EXPECT_EQ(answer.why_not_whole(), "it has no end");
  }
  for (std::size_t missing = 0; missing < all.size(); ++missing) {
    Messages some = all;
    some.erase(some.begin() + static_cast<std::ptrdiff_t>(missing));
    EXPECT_EQ(heard(some).stop(), Stop::NotAll) << missing;
    EXPECT_NE(heard(some).why_not_whole(), "") << missing;
  }
}

TEST(SafeAnswer, WithOneMoreThanItsLastLineCountsSaysThatNotAllHaveStopped) {
  for (const char* last : {"END 1 2\n", "END 1 4\n", "END 1 0\n", "END 1 03x\n", "END 1\n", "END 1 \n", "END 1 -3\n",
                           "END\n", "END 1 3 more\n", "END 1 18446744073709551619\n"}) {
    Messages messages = whole({true, true, true});
    messages.back() = last;
    EXPECT_EQ(heard(messages).stop(), Stop::NotAll) << last;
    EXPECT_NE(heard(messages).why_not_whole(), "") << last;
  }
  Messages more = whole({true});
  more.push_back(safe_line(true, "HAND and more"));
  EXPECT_EQ(heard(more).stop(), Stop::NotAll);
  EXPECT_EQ(heard(more).why_not_whole(), "it goes on behind its end");
}

TEST(SafeAnswer, OfAnUnknownWordSaysThatNotAllHaveStopped) {
  for (const char* message : {"STOPPED\n", "STOPPED \n", "UNCONFIRMED\n", "stopped MOTOR\n", "STOPPEDMOTOR x\n",
                              "STANDS MOTOR stopped 3 ms\n", "\n", "", " STOPPED MOTOR\n"})
    for (std::size_t at = 0; at < 3; ++at) {
      Messages messages = whole({true, true});
      messages[at] = message;
      EXPECT_EQ(heard(messages).stop(), Stop::NotAll) << '"' << message << "\" as message " << at;
      EXPECT_NE(heard(messages).why_not_whole(), "") << message;
    }
}

TEST(SafeAnswer, OfAGuardBeforeItHadAVersionSaysThatNotAllHaveStopped) {
  // Those of 0.1.0 before adr 0167, word by word: an end of the connection was their end.
  EXPECT_EQ(heard({"MOTOR stopped 0 ms, says the device\n", "HAND stopped 0 ms\n"}).stop(), Stop::NotAll);
  EXPECT_EQ(heard({"MOTOR did not confirm that it stopped\n"}).stop(), Stop::NotAll);
  EXPECT_NE(heard({"HAND stopped 0 ms\n"}).why_not_whole().find("another version"), std::string_view::npos);
}

TEST(SafeAnswer, OfALaterVersionSaysThatNotAllHaveStopped) {
  Messages messages = whole({true, true});
  messages.back() = "END 2 2\n";
  EXPECT_EQ(heard(messages).stop(), Stop::NotAll);
  EXPECT_NE(heard(messages).why_not_whole().find("another version"), std::string_view::npos);
}

TEST(SafeAnswer, WithALineThatWasCutOffSaysThatNotAllHaveStopped) {
  SafeAnswer answer;
  answer.take_cut_off();
  answer.take(safe_last_line(0));
  EXPECT_EQ(answer.stop(), Stop::NotAll);
  EXPECT_NE(answer.why_not_whole(), "");
}

TEST(SafeAnswer, HasWordsForAHumanBeingWithoutThoseForAProgram) {
  SafeAnswer answer;
  EXPECT_EQ(answer.take(safe_line(true, "MOTOR stopped 40 ms")), "MOTOR stopped 40 ms");
  EXPECT_EQ(answer.take(safe_line(false, "HAND did not confirm that it stopped")),
            "HAND did not confirm that it stopped");
  EXPECT_EQ(answer.take("WHO knows\n"), "WHO knows") << "what is not known is shown as it is";
  EXPECT_EQ(answer.take(safe_last_line(2)), "");
}

}  // namespace
}  // namespace hirosco::supervisor
