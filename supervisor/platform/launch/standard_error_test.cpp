// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/standard_error.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <array>

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

TEST(StandardErrorLines, ShowControlCharactersAsText) {
  EXPECT_EQ(shown("red \x1b[31m bell \a tab\t end \xc3"), "red \\x1b[31m bell \\x07 tab  end \\xc3");
}

TEST(StandardErrorLines, OfATalkativeSpeakerAreLimitedAndCountedExactlyAndNobodyElsesAre) {
  LineLimit limit{20};
  int admitted = 0;
  for (int i = 0; i < 2'000'000; ++i) admitted += limit.admit("LOUD") ? 1 : 0;
  EXPECT_EQ(admitted, 20);
  EXPECT_TRUE(limit.admit("QUIET"));
  EXPECT_THAT(limit.turn(), ElementsAre(Pair("LOUD", 1'999'980U)));
  EXPECT_TRUE(limit.admit("LOUD")) << "the next turn is a new one";
  EXPECT_TRUE(limit.turn().empty());
}

TEST(StandardErrorLines, AreBoundedInLengthAndPutTogetherFromPieces) {
  LineCutter cutter;
  std::vector<std::string> lines;
  const auto line = [&](std::string_view text) { lines.emplace_back(text); };
  cutter.take("one\ntw", line);
  cutter.take("o\n\nrest", line);
  cutter.end(line);
  EXPECT_THAT(lines, ElementsAre("one", "two", "rest"));
  lines.clear();
  cutter.take(std::string(1'000'000, 'x') + "\nnext\n", line);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].size(), LineCutter::longest + 3);
  EXPECT_EQ(lines[1], "next");
}

TEST(StandardErrorLines, AreNamedAfterWhoWroteThemToTheLastOne) {
  std::vector<std::string> printed;
  {
    StandardError lines{[&](const std::string& line) { printed.push_back(line); }};
    auto arm = lines.open("ARM");
    auto hand = lines.open("HAND");
    ASSERT_TRUE(arm && hand);
    ASSERT_EQ(::write(arm->get(), "sensor \x1b broken\n", 16), 16);
    ASSERT_EQ(::write(hand->get(), "no end", 6), 6);
    arm->reset();
    hand->reset();
  }
  EXPECT_THAT(printed, ::testing::UnorderedElementsAre("ARM: sensor \\x1b broken\n", "HAND: no end\n"));
}

/// As of a terminal under Ctrl-S, or `2>&1 | less`.
TEST(StandardErrorLines, WhileNobodyTakesWhatIsPrintedWhoWritesIsReadAllTheSame) {
  std::array<int, 2> ends{-1, -1};
  ASSERT_EQ(::pipe(ends.data()), 0);
  FileDescriptor nobody_reads{ends[0]}, full{ends[1]};
  ASSERT_EQ(::fcntl(full.get(), F_SETFL, O_NONBLOCK), 0);
  while (::write(full.get(), "#", 1) == 1) {}
  ASSERT_EQ(::fcntl(full.get(), F_SETFL, 0), 0);
  const FileDescriptor before{::dup(STDERR_FILENO)};
  ASSERT_EQ(::dup2(full.get(), STDERR_FILENO), STDERR_FILENO);
  std::size_t written = 0;
  constexpr std::size_t wanted = 1'000'000;  // far more than a pipe has room for
  {
    StandardError lines;
    auto arm = lines.open("ARM");
    if (arm && ::fcntl(arm->get(), F_SETFL, O_NONBLOCK) == 0)
      for (pollfd look{arm->get(), POLLOUT, 0}; written < wanted && ::poll(&look, 1, 10'000) == 1;)
        if (const auto octets = ::write(arm->get(), "the sensor is broken\n", 21); octets > 0)
          written += static_cast<std::size_t>(octets);
    if (written < wanted) nobody_reads.reset();  // or the end of this test would wait, too
  }
  ASSERT_EQ(::dup2(before.get(), STDERR_FILENO), STDERR_FILENO);
  EXPECT_GE(written, wanted);
}

}  // namespace
}  // namespace hirosco::supervisor
