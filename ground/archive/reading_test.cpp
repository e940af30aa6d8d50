// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ground/archive/archive.hpp"
#include "ground/testing/workshop.hpp"

/// What an archive answers.
namespace hirosco::ground {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::opening;
using ::testing::SizeIs;

class AFilledArchive : public testing::ArchiveOfAWorkshop {
 protected:
  /// A packet of one octet.
  void keep(int after_s, std::uint16_t apid, std::uint16_t sid, std::uint8_t octet) {
    StoredPacket stored;
    stored.t = opening + after_s * 1s;
    stored.apid = apid;
    stored.sid = sid;
    const std::array data{std::byte{octet}};
    archive->add(stored, data);
  }
  [[nodiscard]] static int octet_of(const StoredPacket& packet) { return std::to_integer<int>(packet.octets.at(0)); }
  /// All that a question hands over, as far as `most`.
  [[nodiscard]] auto into(std::vector<int>& taken, std::size_t most = 100) {
    return [&taken, most](const StoredPacket& packet) {
      taken.push_back(octet_of(packet));
      return taken.size() < most;
    };
  }
  void says(const std::string& text, int severity = 1, int after_s = 0) {
    archive->add(StoredEvent{.t = opening + after_s * 1s,
                             .apid = testing::drill_apid,
                             .subsystem = "DRILL",
                             .id = 7,
                             .name = "NAME",
                             .severity = severity,
                             .text = text,
                             .values = "{}"});
  }
  [[nodiscard]] std::vector<std::string> texts(const Archive::Filter& filter) {
    std::vector<std::string> all;
    for (const StoredEvent& event : archive->events(filter)) all.push_back(event.text);
    return all;
  }
  void changes_to(int after_s, const char* kind, const char* name, const char* value) {
    archive->add(StoredChange{opening + after_s * 1s, kind, name, value});
  }
};

TEST_F(AFilledArchive, ReachesFromItsOldestToItsNewestPacket) {
  EXPECT_FALSE(archive->extent());
  keep(5, 10, 0, 1);
  keep(2, 10, 0, 2);
  keep(4, 10, 0, 3);
  const auto extent = archive->extent();
  ASSERT_TRUE(extent);
  EXPECT_EQ(extent->from, opening + 2s);
  EXPECT_EQ(extent->to, opening + 5s);
}

TEST_F(AFilledArchive, HandsOverPacketsInOrderOfTimeAsLongAsTheyAreWanted) {
  keep(2, 10, 0, 3);
  keep(1, 10, 0, 1);
  keep(1, 11, 7, 2);
  keep(3, 10, 0, 4);
  std::vector<int> all, two, some;
  archive->packets({}, into(all));
  archive->packets({}, into(two, 2));
  archive->packets({opening + 2s, opening + 2s}, into(some));
  EXPECT_THAT(all, ElementsAre(1, 2, 3, 4)) << "of one time those first that came first";
  EXPECT_THAT(two, ElementsAre(1, 2));
  EXPECT_THAT(some, ElementsAre(3)) << "both ends are of the span";
}

TEST_F(AFilledArchive, HandsThemOverBackwardsFromATimeOrFromAPacketOn) {
  using enum Archive::Housekeeping;
  keep(1, 10, 0, 1);
  keep(1, 10, 7, 2);
  keep(1, 10, 0, 3);
  keep(2, 10, 0, 4);
  std::vector<int> without, with, older, nothing;
  std::vector<std::int64_t> numbers;
  archive->packets_back(opening + 1s, 0, LeftOut, [&](const StoredPacket& packet) {
    numbers.push_back(packet.number);
    without.push_back(octet_of(packet));
    return true;
  });
  EXPECT_THAT(without, ElementsAre(3, 1));
  archive->packets_back(OnboardTime::max(), 0, Included, into(with));
  EXPECT_THAT(with, ElementsAre(4, 3, 2, 1));
  archive->packets_back(OnboardTime::max(), numbers.at(0), Included, into(older));
  EXPECT_THAT(older, ElementsAre(2, 1)) << "of the same time, too";
  archive->packets_back(OnboardTime::max(), 12345, Included, into(nothing));
  EXPECT_THAT(nothing, IsEmpty()) << "that packet has made room";
}

TEST_F(AFilledArchive, FindsTheReportsOfOneStructure) {
  keep(1, 10, 7, 1);
  keep(2, 10, 8, 2);
  keep(3, 11, 7, 3);
  keep(4, 10, 7, 4);
  std::vector<int> reports;
  archive->packets_of(10, 7, {}, into(reports));
  EXPECT_THAT(reports, ElementsAre(1, 4));
  const auto last = archive->last_of(10, 7, opening + 3s);
  ASSERT_TRUE(last);
  EXPECT_EQ(octet_of(*last), 1);
  EXPECT_EQ(last->t, opening + 1s);
  EXPECT_EQ(octet_of(archive->last_of(10, 7, opening + 4s).value()), 4) << "one of that very time counts";
  EXPECT_FALSE(archive->last_of(10, 7, opening));
  EXPECT_FALSE(archive->last_of(10, 9, OnboardTime::max()));
}

TEST_F(AFilledArchive, FindsEventsBySpanSeverityAndText) {
  says("one", 1, 0);
  says("two", 3, 1);
  says("three", 4, 2);
  EXPECT_THAT(texts({.span = {}, .text = {}}), ElementsAre("three", "two", "one"));
  EXPECT_THAT(texts({.span = {}, .text = {}, .newest_first = false}), ElementsAre("one", "two", "three"));
  EXPECT_THAT(texts({.span = {}, .severity = 3, .text = {}}), ElementsAre("three", "two"));
  EXPECT_THAT(texts({.span = {opening + 1s, opening + 1s}, .text = {}}), ElementsAre("two"));
  EXPECT_THAT(texts({.span = {}, .text = "TWO"}), ElementsAre("two"));
  EXPECT_THAT(texts({.span = {}, .text = "drill name t"}), ElementsAre("three", "two")) << "over all of the line";
  EXPECT_THAT(texts({.span = {}, .text = {}, .limit = 2}), ElementsAre("three", "two"));
  EXPECT_EQ(archive->count_events({}, 3), 2);
  EXPECT_EQ(archive->count_events({opening + 2s}, 3), 1);
}

TEST_F(AFilledArchive, TakesEveryLetterOfASearchForItself) {
  says("100 %");
  says("a_b");
  says("axb");
  says("c\\d");
  says("'; DROP TABLE events; --");
  EXPECT_THAT(texts({.span = {}, .text = "%"}), ElementsAre("100 %"));
  EXPECT_THAT(texts({.span = {}, .text = "a_b"}), ElementsAre("a_b"));
  EXPECT_THAT(texts({.span = {}, .text = "\\"}), ElementsAre("c\\d"));
  EXPECT_THAT(texts({.span = {}, .text = "'; drop"}), SizeIs(1));
}

TEST_F(AFilledArchive, FindsTelecommandsAndTheirReports) {
  const auto bore = commanded("BORE", opening, "anna");
  const auto wipe = commanded("WIPE", opening + 1s, "ben");
  reported(wipe, opening + 2s, "accepted");
  reported(bore, opening + 3s, "failed", 10);
  const auto found = archive->commands({.span = {}, .text = "ANNA"});
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].number, bore);
  EXPECT_EQ(found[0].stage, "failed") << "its last one";
  EXPECT_EQ(found[0].code, 10);
  EXPECT_EQ(archive->command(wipe)->code, std::nullopt);
  EXPECT_FALSE(archive->command(wipe + 1));
  EXPECT_THAT(archive->reports(bore), SizeIs(1));
  const auto within = archive->reports_in({opening + 2s, opening + 3s});
  ASSERT_THAT(within, SizeIs(2));
  EXPECT_EQ(within[0].first, wipe);
  EXPECT_EQ(within[1].first, bore);
  EXPECT_EQ(within[1].second.reason, "because");
  EXPECT_EQ(archive->count_commands({opening + 1s}), 1);
  archive->add(0, StoredReport{opening + 9s, "completed", std::nullopt, ""});
  EXPECT_THAT(archive->reports_in({opening + 9s}), IsEmpty()) << "one that the disk refused has no reports";
}

TEST_F(AFilledArchive, BeginsAStoryOfChangesWithWhatHeldThen) {
  changes_to(0, "mode", "", "dark");
  changes_to(1, "mode", "", "work");
  changes_to(1, "state", "DRILL", "Operational");
  changes_to(3, "mode", "", "dark");
  const auto told = archive->changes({opening + 2s, opening + 3s});
  ASSERT_THAT(told, SizeIs(3));
  EXPECT_EQ(told[0].value, "work");
  EXPECT_EQ(told[0].t, opening + 2s);
  EXPECT_EQ(told[1].value, "Operational");
  EXPECT_EQ(told[2].value, "dark");
  EXPECT_EQ(told[2].t, opening + 3s);
}

TEST_F(AFilledArchive, OfTooManyChangesBeginsTheStoryLater) {
  changes_to(0, "mode", "", "work");
  for (int i = 0; i < 10'001; ++i) changes_to(1 + i, "link", "1", i % 2 == 0 ? "up" : "down");
  const auto told = archive->changes({});
  ASSERT_THAT(told, SizeIs(2 + 10'000));
  EXPECT_EQ(told[0].t, opening + 2s);
  EXPECT_EQ(told[1].t, opening + 2s);
  EXPECT_EQ(told[2].t, opening + 2s) << "the oldest that has room, behind what held before it";
  EXPECT_EQ(told.back().t, opening + 10'001s);
}

TEST_F(AFilledArchive, HasGapsThatReachIntoASpanUntilTheyAreClosed) {
  archive->add(StoredGap{opening, opening + 2s});
  archive->add(StoredGap{opening + 4s, opening + 6s});
  EXPECT_THAT(archive->gaps({opening + 2s, opening + 4s}), SizeIs(2));
  EXPECT_THAT(archive->gaps({opening + 3s, opening + 3s}), IsEmpty());
  archive->close_gaps({opening + 1s, opening + 6s});
  ASSERT_THAT(archive->gaps({}), SizeIs(1)) << "one that begins before is still one";
  EXPECT_EQ(archive->gaps({})[0].from, opening);
}

TEST_F(AFilledArchive, HasMarksOfOneKindOrOfAllAndOfManyTheNewest) {
  for (const char* name : {"1", "2", "3"})
    archive->add(StoredMark{.t = opening, .kind = "flight", .name = name, .action = "began", .who = "", .note = ""});
  archive->add(StoredMark{.t = opening + 1s,
                          .kind = "alarm",
                          .name = "10/7",
                          .action = "shelve",
                          .who = "anna",
                          .note = "later",
                          .until = opening + 60s});
  EXPECT_THAT(archive->marks("", {}), SizeIs(4));
  EXPECT_THAT(archive->marks("", {opening + 1s}), SizeIs(1));
  const auto alarms = archive->marks("alarm", {});
  ASSERT_THAT(alarms, SizeIs(1));
  EXPECT_EQ(alarms[0].who, "anna");
  EXPECT_EQ(alarms[0].until, opening + 60s);
  const auto newest = archive->marks("flight", {}, 2);
  ASSERT_THAT(newest, SizeIs(2));
  EXPECT_EQ(newest[0].name, "2") << "oldest first";
  EXPECT_EQ(newest[1].name, "3");
}

}  // namespace
}  // namespace hirosco::ground
