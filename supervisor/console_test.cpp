// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/console.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <memory>

#include "supervisor/testing/pair_overview.hpp"

namespace hirosco::supervisor {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

struct ConsoleTest : ::testing::Test {
  using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
  /// What a console writes of what it is told, to its end.
  template <class Tell>
  std::vector<std::string> shown(Console::Style style, Tell tell) {
    const File file{std::tmpfile(), std::fclose};
    {
      Console console{mission, style, file.get()};
      tell(console);
    }
    return lines_of(file.get());
  }
  static std::vector<std::string> lines_of(std::FILE* file) {
    std::rewind(file);
    std::vector<std::string> lines{""};
    for (int letter = std::fgetc(file); letter != EOF; letter = std::fgetc(file)) {
      if (letter == '\n') lines.emplace_back();
      else lines.back() += static_cast<char>(letter);
    }
    EXPECT_EQ(lines.back(), "") << "each line is whole";
    lines.pop_back();
    return lines;
  }

  const OnboardTime when{std::chrono::hours{1}};
  descriptor::Mission mission;
};

TEST_F(ConsoleTest, ShowsOneSpeakersLinesUpToALimitAndCountsTheOthersExactly) {
  const auto lines = shown(Console::Style::Text, [&](Console& console) {
    for (int i = 0; i < 357'100; ++i) console.told(when, "HAND info STRAY");
    console.told(when, "ARM low TEMPERATURE");
  });
  EXPECT_EQ(lines.size(), Console::most_told + 2);
  EXPECT_THAT(lines, Contains(EndsWith("ARM low TEMPERATURE"))) << "the others are heard";
  EXPECT_THAT(lines.back(), EndsWith("HAND: 356900 more lines in this second are in the log only"));
}

TEST_F(ConsoleTest, GivesTheTerminalNothingButWhatCanBePrinted) {
  for (const auto style : {Console::Style::Text, Console::Style::Json}) {
    const auto lines = shown(style, [&](Console& console) { console.told(when, "ARM \x1b[2J\"said\"\n\x7f\xc3\xa4"); });
    ASSERT_EQ(lines.size(), 1U);
    for (const char letter : lines[0]) EXPECT_TRUE(letter >= ' ' && letter < 127) << lines[0];
  }
}

TEST_F(ConsoleTest, TellsInLinesWhatHasChangedAndNothingElse) {
  const auto lines = shown(Console::Style::Text, [&](Console& console) {
    Overview overview = testing::pair();
    console.show(overview, 1s);
    overview.members[0].cycles = 9000;  // rises all the time
    overview.members[0].latency_max_ns = 40'000;
    console.show(overview, 2s);
    overview.members[1].state = "Offline";
    overview.members[1].inhibited = 4;
    overview.links[0].up = false;
    console.show(overview, 3s);
    console.show(overview, 4s);
  });
  EXPECT_THAT(lines, ::testing::ElementsAre("[   1.0 s] mode coupled; ARM Operational; HAND Operational; links 2/2",
                                            "[   3.0 s] HAND Offline, inhibited; links 1/2"));
}

TEST_F(ConsoleTest, TellsCountsThatRiseAllTheTimeEveryTenSeconds) {
  const auto lines = shown(Console::Style::Text, [&](Console& console) {
    Overview overview = testing::pair();
    for (int second = 1; second <= 25; ++second) {
      overview.members[0].missed = static_cast<std::uint64_t>(second);
      console.show(overview, std::chrono::seconds{second});
    }
  });
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_THAT(lines[0], EndsWith("ARM Operational; ARM missed 1 cycles; HAND Operational; links 2/2"));
  EXPECT_EQ(lines[1], "[  11.0 s] ARM missed 11 cycles");
  EXPECT_EQ(lines[2], "[  21.0 s] ARM missed 21 cycles");
}

TEST_F(ConsoleTest, EndsWithTheFiguresOfWhoCycled) {
  const auto lines = shown(Console::Style::Text, [&](Console& console) {
    console.show(testing::pair(), 1s);
    Overview down = testing::pair();
    for (Overview::Member& member : down.members) member = {.name = member.name};
    console.show(down, 2s);
    console.ended();
  });
  ASSERT_GE(lines.size(), 2U);
  EXPECT_EQ(lines.back(), "HAND: 1000 cycles, 0 missed, 0 overran, 31.0 us late at most");
}

TEST_F(ConsoleTest, TellsAScreenAllThatItShowsInOneLineEachTime) {
  const auto lines = shown(Console::Style::Screen, [&](Console& console) {
    console.told(when, "ARM info \"X\"");
    console.show(testing::pair(), 1s);
    console.ended();
  });
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], R"({"at_s":0.0000,"told":"ARM info \"X\""})");
  EXPECT_THAT(lines[1],
              AllOf(HasSubstr(R"("mission":"PAIR","mode":"coupled")"),
                    HasSubstr(R"({"name":"ARM","runs":true,"state":"Operational","wanted":"Operational")"),
                    HasSubstr(R"({"id":1,"from":"ARM","to":"HAND","up":true,"wanted":true})"), EndsWith("}")));
}

TEST_F(ConsoleTest, IsQuietIfToldTo) {
  EXPECT_TRUE(shown(Console::Style::Quiet, [&](Console& console) { console.told(when, "ARM info X"); }).empty());
}

TEST_F(ConsoleTest, ATerminalThatStandsStillHoldsUpNobodyAndIsToldWhatItMissed) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const File terminal{::fdopen(ends[1], "w"), std::fclose};
  constexpr int told = 20'000;
  std::vector<std::string> lines;
  {
    Console console{mission, Console::Style::Text, terminal.get()};
    const std::string text(200, 'x');
    // Each line has a speaker of its own; nobody reads yet, and the pipe holds far less than all of them.
    for (int i = 0; i < told; ++i) console.told(when, "SPEAKER" + std::to_string(i) + " " + text);
    std::thread reader{[&] {
      const File pipe{::fdopen(ends[0], "r"), std::fclose};
      std::string line;
      for (int letter = std::fgetc(pipe.get()); letter != EOF && line != "the end"; letter = std::fgetc(pipe.get())) {
        if (letter != '\n') line += static_cast<char>(letter);
        else lines.push_back(std::exchange(line, {}));
        if (lines.size() != 0 && lines.back().ends_with("LAST")) return;
      }
    }};
    console.told(when, "SPEAKER LAST");
    reader.join();
  }
  std::size_t shown_lines = 0;
  std::size_t missed = 0;
  for (const std::string& line : lines) {
    if (!line.ends_with("are in the log only: the terminal stood still")) ++shown_lines;
    else missed += std::stoul(line.substr(line.find_first_not_of(' ')));
  }
  EXPECT_GT(missed, 0U);
  EXPECT_EQ(shown_lines + missed, told + 1U);
}

}  // namespace
}  // namespace hirosco::supervisor
