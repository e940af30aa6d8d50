// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/succession/journal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

/// What a supervisor knows, for one that goes on for it (docs/adr/0093): a death may tear whatever was being written.
namespace hirosco::supervisor {
namespace {

constexpr std::size_t memory_octets = 4096;

std::vector<std::byte> octets_of(const std::string& text) {
  const auto octets = std::as_bytes(std::span{text});
  return {octets.begin(), octets.end()};
}
std::string text_of(Octets octets) { return {reinterpret_cast<const char*>(octets.data()), octets.size()}; }

struct Journals : ::testing::Test {
  std::vector<std::byte> memory = std::vector<std::byte>(memory_octets);
  Journal journal{memory};
};

TEST_F(Journals, FreshMemoryHoldsNothing) { EXPECT_TRUE(journal.newest().empty()); }

TEST_F(Journals, TheNewestCopyIsFoundByWhoeverComesNext) {
  for (const std::string text : {"first", "second, which is longer", "3"}) {
    ASSERT_TRUE(journal.write(octets_of(text)));
    EXPECT_EQ(text_of(Journal{memory}.newest()), text);
  }
}

TEST_F(Journals, WhatIsTooLongIsNotWrittenAndTheLastStays) {
  ASSERT_TRUE(journal.write(octets_of("kept")));
  EXPECT_FALSE(journal.write(std::vector<std::byte>(journal.most_octets() + 1)));
  EXPECT_EQ(text_of(journal.newest()), "kept");
  EXPECT_TRUE(journal.write(std::vector<std::byte>(journal.most_octets())));
  EXPECT_EQ(Journal{memory}.newest().size(), journal.most_octets());
}

TEST_F(Journals, ATornCopyIsNeverUsedWhereverItWasTorn) {
  ASSERT_TRUE(journal.write(octets_of("one whole copy")));
  ASSERT_TRUE(journal.write(octets_of("and the one that was whole when it died")));
  const auto before = memory;
  ASSERT_TRUE(journal.write(octets_of("a third, over the first")));
  const auto after = memory;
  // The writer died after so many octets, from either end: whatever the order in which they reached the memory.
  for (std::size_t torn = 0; torn <= memory.size(); ++torn) {
    for (const bool front : {true, false}) {
      auto found = front ? before : after;
      const auto& other = front ? after : before;
      std::copy_n(other.begin(), torn, found.begin());
      const std::string text = text_of(Journal{found}.newest());
      EXPECT_TRUE(text == "and the one that was whole when it died" || text == "a third, over the first")
          << torn << text;
    }
  }
}

TEST_F(Journals, EveryFlippedBitOfTheNewestLeavesTheOneBefore) {
  ASSERT_TRUE(journal.write(octets_of("before")));
  ASSERT_TRUE(journal.write(octets_of("newest")));
  const std::size_t half = memory.size() / 2;
  for (std::size_t bit = 0; bit < 8 * (32 + 6); ++bit) {
    auto damaged = memory;
    damaged[half + bit / 8] ^= std::byte{1} << (bit % 8);
    EXPECT_EQ(text_of(Journal{damaged}.newest()), "before") << bit;
  }
}

TEST_F(Journals, TwoDamagedCopiesAreNone) {
  ASSERT_TRUE(journal.write(octets_of("before")));
  ASSERT_TRUE(journal.write(octets_of("newest")));
  memory[33] ^= std::byte{1};
  memory[memory.size() / 2 + 34] ^= std::byte{1};
  EXPECT_TRUE(Journal{memory}.newest().empty());
}

TEST_F(Journals, MemoryThatIsTooSmallHoldsNothingAndHarmsNobody) {
  for (std::size_t octets = 0; octets < 66; ++octets) {
    std::vector<std::byte> little(octets);
    Journal small{little};
    EXPECT_TRUE(small.newest().empty()) << octets;
    static_cast<void>(small.write(octets_of("x")));
  }
}

/// Each octet of both copies, in a loop that commands: what a supervisor notes before it acts must cost little.
TEST_F(Journals, WhoWritesOnDoesNotReadWhatItHasWritten) {
  ASSERT_TRUE(journal.write(octets_of("first")));
  ASSERT_TRUE(journal.write(octets_of("second")));
  const std::size_t second = memory.size() / 2;
  memory[second + 33] ^= std::byte{1};
  const std::vector<std::byte> damaged(memory.begin() + static_cast<std::ptrdiff_t>(second), memory.end());
  ASSERT_TRUE(journal.write(octets_of("third")));
  EXPECT_TRUE(std::equal(damaged.begin(), damaged.end(), memory.begin() + static_cast<std::ptrdiff_t>(second)));
  EXPECT_EQ(text_of(journal.newest()), "third");
}

TEST_F(Journals, WhoComesNextGoesOnFromTheNewestWholeCopyWhicheverThatIs) {
  for (const bool newest_is_torn : {false, true}) {
    ASSERT_TRUE(journal.write(octets_of("older")));
    ASSERT_TRUE(journal.write(octets_of("newest")));
    const bool in_second = memory[memory.size() / 2 + 32] == std::byte{'n'};
    if (newest_is_torn) memory[(in_second ? memory.size() / 2 : 0) + 32] ^= std::byte{1};
    Journal next{memory};
    ASSERT_TRUE(next.write(octets_of("of the next")));
    EXPECT_EQ(text_of(Journal{memory}.newest()), "of the next");
    memory[(in_second == newest_is_torn ? memory.size() / 2 : 0) + 32] ^= std::byte{1};
    EXPECT_EQ(text_of(Journal{memory}.newest()), newest_is_torn ? "older" : "newest") << "the whole one was spared";
    journal = Journal{memory};
  }
}

struct RememberedNumber final : Remembered {
  void note(OctetWriter& writer) const override { writer.put(value); }
  void recall(OctetReader& reader) override { recalled = reader.get<std::uint32_t>(); }
  std::uint32_t value{0};
  std::uint32_t recalled{0};
};
struct Text final : Remembered {
  void note(OctetWriter& writer) const override { writer.put(std::as_bytes(std::span{value})); }
  void recall(OctetReader& reader) override { recalled = text_of(reader.get(reader.remaining())); }
  std::string value;
  std::string recalled;
};

TEST_F(Journals, EachPartIsToldWhatItHadNoted) {
  RememberedNumber number;
  Text text;
  Memory memory_of_one{&journal, {&number, &text}};
  number.value = 7;
  text.value = "seven";
  ASSERT_TRUE(memory_of_one.note());
  RememberedNumber later_number;
  Text later_text;
  Journal later{memory};
  Memory memory_of_next{&later, {&later_number, &later_text}};
  ASSERT_TRUE(memory_of_next.recall());
  EXPECT_EQ(later_number.recalled, 7u);
  EXPECT_EQ(later_text.recalled, "seven");
}

TEST_F(Journals, OtherPartsOrPartsThatReadOtherwiseAreNotTold) {
  RememberedNumber number;
  Memory one{&journal, {&number}};
  number.value = 7;
  RememberedNumber first, second;
  ASSERT_TRUE(one.note());
  EXPECT_FALSE((Memory{&journal, {&first, &second}}.recall()));
  EXPECT_FALSE((Memory{&journal, {}}.recall()));
  EXPECT_EQ(first.recalled, 0u) << "of half a note nothing is kept";
  struct Half final : Remembered {
    void note(OctetWriter&) const override {}
    void recall(OctetReader& reader) override { static_cast<void>(reader.get<std::uint16_t>()); }
  } half;
  EXPECT_FALSE((Memory{&journal, {&half}}.recall()));
}

TEST_F(Journals, WhatHasNoRoomLeavesNoOlderNoteToBelieveUntilItFitsAgain) {
  RememberedNumber stops;
  Text text;
  Memory one{&journal, {&stops, &text}};
  RememberedNumber later_stops;
  Text later;
  Memory next{&journal, {&later_stops, &later}};
  ASSERT_TRUE(one.note());
  text.value = "fits";
  ASSERT_TRUE(one.note()) << "both copies are whole";
  stops.value = 1;
  text.value = std::string(memory_octets, 'x');
  for (int time = 0; time < 2; ++time) {
    EXPECT_FALSE(one.note()) << time;
    EXPECT_FALSE(next.recall()) << "it would say that there was no stop";
  }
  text.value = "fits";
  ASSERT_TRUE(one.note());
  ASSERT_TRUE(next.recall());
  EXPECT_EQ(later_stops.recalled, 1u);
  EXPECT_EQ(later.recalled, "fits");
}

TEST_F(Journals, WhatTwoPartsTogetherHaveNoRoomForIsNotNotedEither) {
  Text first, second;
  Memory one{&journal, {&first, &second}};
  ASSERT_TRUE(one.note());
  first.value = second.value = std::string(journal.most_octets() / 2, 'x');
  EXPECT_FALSE(one.note());
  EXPECT_FALSE(one.recall());
}

TEST_F(Journals, WhatIsClearedIsNoCopyAndTakesTheNextOne) {
  Journal{MutableOctets{}}.clear();
  ASSERT_TRUE(journal.write(octets_of("one")));
  ASSERT_TRUE(journal.write(octets_of("two")));
  journal.clear();
  EXPECT_TRUE(journal.newest().empty());
  ASSERT_TRUE(journal.write(octets_of("three")));
  EXPECT_EQ(text_of(journal.newest()), "three");
}

}  // namespace
}  // namespace hirosco::supervisor
