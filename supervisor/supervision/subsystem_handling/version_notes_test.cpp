// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/version_notes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

namespace hirosco::supervisor {
namespace {

/// What REPLACE takes as a name at most.
const std::string longest_version(24, 'v');

VersionNotes some_notes() {
  VersionNotes notes;
  notes.in_force = {{10, "2.1"}, {11, longest_version}};
  notes.earlier = {{10, ""}, {2039, "1"}};
  notes.on_trial = {{.apid = 12, .wanted = "3", .before = ""}, {.apid = 10, .wanted = "", .before = "2.1"}};
  return notes;
}

std::vector<std::byte> octets_of_notes(const VersionNotes& notes) {
  std::vector<std::byte> octets(1024);
  OctetWriter writer{octets};
  write(writer, notes);
  EXPECT_TRUE(writer.good());
  octets.resize(writer.written().size());
  return octets;
}

void expect_equal(const VersionNotes& read, const VersionNotes& noted) {
  EXPECT_EQ(read.in_force, noted.in_force);
  EXPECT_EQ(read.earlier, noted.earlier);
  ASSERT_EQ(read.on_trial.size(), noted.on_trial.size());
  for (std::size_t i = 0; i < noted.on_trial.size(); ++i) {
    EXPECT_EQ(read.on_trial[i].apid, noted.on_trial[i].apid);
    EXPECT_EQ(read.on_trial[i].wanted, noted.on_trial[i].wanted);
    EXPECT_EQ(read.on_trial[i].before, noted.on_trial[i].before);
  }
}

TEST(VersionNotes, WhatOneSupervisorNotesTheNextOneReads) {
  for (const VersionNotes& noted : {some_notes(), VersionNotes{}}) {
    const auto octets = octets_of_notes(noted);
    OctetReader reader{octets};
    expect_equal(read_version_notes(reader), noted);
    EXPECT_TRUE(reader.exhausted()) << "what is noted behind it is read where it begins";
  }
}

/// Three counts of none; then what the journal has behind that is somebody else's.
TEST(VersionNotes, OfNothingTakeSixOctets) { EXPECT_EQ(octets_of_notes({}), std::vector<std::byte>(6)); }

TEST(VersionNotes, AreInTheOrderThatAJournalOfBeforeHas) {
  VersionNotes notes;
  notes.in_force = {{0x0102, "A"}};
  notes.on_trial = {{.apid = 0x0304, .wanted = "B", .before = ""}};
  const auto octets = octets_of_notes(notes);
  constexpr std::array<unsigned, 15> expected{0, 1, 1, 2, 1, 'A', 0, 0, 0, 1, 3, 4, 1, 'B', 0};
  ASSERT_EQ(octets.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(std::to_integer<unsigned>(octets[i]), expected[i]) << i;
}

TEST(VersionNotes, CutOffAnywhereTheReaderTellsSoAndWhatIsReadIsBounded) {
  const auto octets = octets_of_notes(some_notes());
  for (std::size_t left = 0; left < octets.size(); ++left) {
    OctetReader reader{Octets{octets}.first(left)};
    const auto read = read_version_notes(reader);
    EXPECT_FALSE(reader.good()) << left;
    EXPECT_LE(read.in_force.size() + read.earlier.size() + read.on_trial.size(), 7u) << left;
  }
}

TEST(VersionNotes, ACountThatIsDamagedReadsNoFurtherThanThereIs) {
  auto octets = octets_of_notes(some_notes());
  octets[0] = octets[1] = std::byte{0xFF};
  OctetReader reader{octets};
  const auto read = read_version_notes(reader);
  EXPECT_FALSE(reader.good());
  EXPECT_LT(read.in_force.size(), octets.size());
}

}  // namespace
}  // namespace hirosco::supervisor
