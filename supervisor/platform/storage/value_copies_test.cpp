// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/value_copies.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>

#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

struct PowerLost {};

/// Loses its power before the step that the test says. What was not on the disk then is there in part, as the test says, too.
class FailingValueDisk final : public MemoryValueDisk {
 public:
  void lose_power_before(int step) { steps_left_ = step; }
  /// Of a file that was created and not synchronised `prefix` octets are there; names given since the folder was synchronised
  /// are there or not.
  void come_back(std::size_t prefix, bool names_are_there) {
    for (const Path& file : unsynced_)
      if (auto found = files_.find(file); found != files_.end())
        found->second.resize(std::min(prefix, found->second.size()));
    for (const auto& [file, before] : before_) {
      if (names_are_there) break;
      if (before) files_[file] = *before;
      else files_.erase(file);
    }
    unsynced_.clear();
    before_.clear();
    steps_left_.reset();
  }
  void damage(const Path& file, std::size_t at, std::byte change) { files_.at(file).at(at) ^= change; }
  void cut(const Path& file, std::size_t length) { files_.at(file).resize(length); }
  void remove(const Path& file) { files_.erase(file); }
  [[nodiscard]] std::size_t octets(const Path& file) const { return files_.at(file).size(); }

  Result<> create(const Path& file, Octets octets) override {
    step();
    unsynced_.insert(file);
    return MemoryValueDisk::create(file, octets);
  }
  Result<> sync(const Path& file) override {
    step();
    unsynced_.erase(file);
    return ok();
  }
  Result<> rename(const Path& from, const Path& to) override {
    step();
    const auto known = files_.find(to);
    before_.emplace(to, known != files_.end() ? std::optional{known->second} : std::nullopt);
    if (unsynced_.erase(from) != 0) unsynced_.insert(to);
    return MemoryValueDisk::rename(from, to);
  }
  Result<> sync_folder(const Path&) override {
    step();
    before_.clear();
    return ok();
  }

 private:
  void step() {
    if (steps_left_ && (*steps_left_)-- == 0) throw PowerLost{};
  }
  std::optional<int> steps_left_;
  std::set<Path> unsynced_;
  std::map<Path, std::optional<std::vector<std::byte>>> before_;
};

[[nodiscard]] ValueCopy change(std::uint64_t number) {
  return {7, number, OnboardTime{Duration{static_cast<std::int64_t>(number)}},
          std::vector<std::byte>(20, static_cast<std::byte>(number))};
}

/// The newest whole one; 0: none.
[[nodiscard]] std::uint64_t newest(const TwoCopies& both) {
  std::uint64_t found = 0;
  for (const auto& copy : both)
    if (copy) {
      EXPECT_EQ(*copy, change(copy->sequence));
      found = std::max(found, copy->sequence);
    }
  return found;
}

constexpr int steps_of_a_write = 8;

struct ValueCopiesTest : ::testing::Test {
  FailingValueDisk disk;
  ValueCopies copies{disk, "values/ARM"};
};

TEST_F(ValueCopiesTest, BeforeAnythingWasKeptBothAreMissing) {
  for (const auto& copy : copies.read()) EXPECT_EQ(copy, std::unexpected{CopyFault::Missing});
}

TEST_F(ValueCopiesTest, AChangeStandsInBoth) {
  for (const std::uint64_t number : {1U, 2U, 3U}) {
    ASSERT_TRUE(copies.write(change(number)));
    for (const auto& copy : copies.read()) EXPECT_EQ(copy, change(number));
  }
}

TEST_F(ValueCopiesTest, WithWhicheverOctetOfWhicheverCopyDamagedTheNewestChangeIsThere) {
  ASSERT_TRUE(copies.write(change(1)));
  ASSERT_TRUE(copies.write(change(2)));
  for (const std::size_t copy : {0U, 1U})
    for (std::size_t at = 0; at < disk.octets(copies.path(copy)); ++at) {
      disk.damage(copies.path(copy), at, std::byte{0x10});
      const TwoCopies both = copies.read();
      EXPECT_EQ(both[copy], std::unexpected{CopyFault::Damaged});
      EXPECT_EQ(newest(both), 2U);
      disk.damage(copies.path(copy), at, std::byte{0x10});
    }
}

TEST_F(ValueCopiesTest, WithWhicheverCopyCutAtAnyLengthOrGoneTheNewestChangeIsThere) {
  for (const std::size_t copy : {0U, 1U}) {
    ASSERT_TRUE(copies.write(change(3)));
    for (std::size_t length = disk.octets(copies.path(copy)); length-- > 0;) {
      disk.cut(copies.path(copy), length);
      EXPECT_EQ(newest(copies.read()), 3U) << length;
    }
    disk.remove(copies.path(copy));
    EXPECT_EQ(newest(copies.read()), 3U);
  }
}

/// Each step of a write, whatever of the steps before it had reached the disk, after any state that an earlier loss had left.
TEST(ValueCopies, HaveTheNewestChangeOrTheOneBeforeWheneverThePowerGoes) {
  for (int earlier = 0; earlier <= steps_of_a_write; ++earlier)
    for (int step = 0; step < steps_of_a_write; ++step)
      for (const std::size_t prefix : {std::size_t{0}, std::size_t{1}, std::size_t{30}, std::size_t{1000}})
        for (const bool names_are_there : {false, true}) {
          FailingValueDisk disk;
          const auto write = [&](std::uint64_t number, int until) {
            ValueCopies copies{disk, "values/ARM"};
            static_cast<void>(copies.read());
            disk.lose_power_before(until);
            try {
              EXPECT_TRUE(copies.write(change(number)));
            } catch (const PowerLost&) {}
            disk.come_back(prefix, names_are_there);
            return newest(ValueCopies{disk, "values/ARM"}.read());
          };
          ASSERT_EQ(write(1, steps_of_a_write), 1U);
          const std::uint64_t before = write(2, earlier);
          ASSERT_TRUE(before == 1U || before == 2U);
          const std::uint64_t after = write(3, step);
          EXPECT_TRUE(after == before || after == 3U) << earlier << " " << step << " " << prefix << " " << after;
          EXPECT_EQ(write(4, steps_of_a_write), 4U);
        }
}

TEST(ValueCopies, OnceTheFirstIsOnTheDiskTheNewestChangeIsThere) {
  for (int step = steps_of_a_write / 2; step < steps_of_a_write; ++step) {
    FailingValueDisk disk;
    ValueCopies copies{disk, "values/ARM"};
    ASSERT_TRUE(copies.write(change(1)));
    disk.lose_power_before(step);
    EXPECT_THROW(static_cast<void>(copies.write(change(2))), PowerLost);
    disk.come_back(0, false);
    EXPECT_EQ(newest(copies.read()), 2U) << step;
  }
}

/// With one damaged, the other is not touched before the damaged one is whole.
TEST(ValueCopies, TheOnlyWholeOneIsTheLastToBeReplaced) {
  for (const std::size_t damaged : {0U, 1U})
    for (int step = 0; step < steps_of_a_write; ++step) {
      FailingValueDisk disk;
      ValueCopies copies{disk, "values/ARM"};
      ASSERT_TRUE(copies.write(change(1)));
      disk.damage(copies.path(damaged), 40, std::byte{1});
      ASSERT_EQ(newest(copies.read()), 1U);
      disk.lose_power_before(step);
      EXPECT_THROW(static_cast<void>(copies.write(change(2))), PowerLost);
      disk.come_back(0, true);
      const auto both = copies.read();
      if (step < steps_of_a_write / 2) {
        EXPECT_EQ(both[1 - damaged], change(1));
      }
      EXPECT_GE(newest(both), 1U);
    }
}

TEST(ValueCopies, StandInTwoFilesOfAFolderThatIsMadeForThem) {
  const TestFolder folder;
  SystemValueDisk disk;
  ValueCopies copies{disk, folder.path() / "flight.values" / "ARM"};
  ASSERT_TRUE(copies.write(change(5)));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "flight.values" / "ARM.1"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "flight.values" / "ARM.2"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator{folder.path() / "flight.values"}, {}), 2);
  for (const auto& copy : (ValueCopies{disk, folder.path() / "flight.values" / "ARM"}.read()))
    EXPECT_EQ(copy, change(5));
}

TEST(ValueCopies, WhatIsNoFileOrTooLongIsNotRead) {
  const TestFolder folder;
  SystemValueDisk disk;
  ValueCopies copies{disk, folder.path() / "ARM"};
  std::filesystem::create_directory(copies.path(0));
  ASSERT_TRUE(disk.create(copies.path(1), std::vector<std::byte>(100'000)));
  const TwoCopies both = copies.read();
  EXPECT_EQ(both[0], std::unexpected{CopyFault::Unreadable});
  EXPECT_EQ(both[1], std::unexpected{CopyFault::Damaged});
}

}  // namespace
}  // namespace hirosco::supervisor
