// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/ascii_database.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <random>

#include "hirosco/utilities/crc32.hpp"
#include "supervisor/platform/storage/testing/batches.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

/// What text has of its own; what it does like every other strategy is in `database_test.cpp`.
namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;

class AsciiFile : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "log"; }
  [[nodiscard]] static std::string line_of(std::uint64_t number, std::size_t packet_octets = 13) {
    return ascii_line(batch_of(number, number, packet_octets).front());
  }
  [[nodiscard]] static std::vector<std::uint64_t> numbers_of(const LogPage& page) {
    std::vector<std::uint64_t> all;
    for (const LogRecord& one : page.records) all.push_back(one.number);
    return all;
  }

 private:
  TestFolder folder_;
};

TEST_F(AsciiFile, SkipsAndCountsATornLastLine) {
  const std::string whole = line_of(1) + '\n' + line_of(2) + '\n';
  const std::size_t first = line_of(1).size() + 1;
  for (std::size_t cut = first + 1; cut < whole.size() - 1; ++cut) {
    std::ofstream{path(), std::ios::trunc} << whole.substr(0, cut);
    auto database = std::move(*open_database(DatabaseStrategy::Ascii, path()));
    ASSERT_EQ(database->read({})->damaged, 1U) << cut;
    ASSERT_TRUE(database->append(batch_of(3, 3)));
    const auto page = database->read({});
    ASSERT_THAT(numbers_of(*page), ElementsAre(1, 3)) << cut;
    ASSERT_EQ(page->damaged, 1U) << cut;
  }
}

TEST_F(AsciiFile, NeverShowsALineWithAFlippedBit) {
  const std::string line = line_of(1);
  ASSERT_TRUE(record_from_ascii(line));
  for (std::size_t bit = 0; bit < line.size() * 8; ++bit) {
    std::string damaged = line;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    EXPECT_FALSE(record_from_ascii(damaged)) << bit;
  }
}

TEST_F(AsciiFile, SaysItsVersionOnceInTheFirstLine) {
  for (const std::uint64_t number : {1U, 2U}) {
    auto database = std::move(*open_database(DatabaseStrategy::Ascii, path()));
    ASSERT_TRUE(database->append(batch_of(number, number)));
    ASSERT_TRUE(database->append(batch_of(number + 2, number + 2)));
  }
  std::ifstream file{path()};
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines.front(), "HIROSCO packet log, version 1 #b16f1e16");  // checksum by Python's zlib.crc32
  const auto page = (*open_database(DatabaseStrategy::Ascii, path(), DatabaseAccess::Read))->read({});
  EXPECT_EQ(page->records.size(), 4U);
  EXPECT_EQ(page->damaged, 0U);
}

TEST_F(AsciiFile, IsReadAndGoneOnInWhereItIsFromBeforeItSaidSo) {
  std::ofstream{path()} << line_of(1) << '\n';
  auto database = std::move(*open_database(DatabaseStrategy::Ascii, path()));
  ASSERT_TRUE(database->append(batch_of(2, 2)));
  const auto page = database->read({});
  EXPECT_THAT(numbers_of(*page), ElementsAre(1, 2));
  EXPECT_EQ(page->damaged, 0U) << "and no version in its midst";
}

TEST_F(AsciiFile, OfAnotherVersionIsNeitherReadNorWritten) {
  const std::string text = ascii_version_line(2) + "\nnobody knows what\n";
  std::ofstream{path()} << text;
  for (const auto access : {DatabaseAccess::Read, DatabaseAccess::Write}) {
    const auto database = open_database(DatabaseStrategy::Ascii, path(), access);
    ASSERT_FALSE(database);
    EXPECT_EQ(database.error().code, ErrorCode::Mismatch);
    EXPECT_EQ(database.error().value, 2);
    EXPECT_STREQ(database.error().text, "log file of another version");
  }
  EXPECT_EQ(std::filesystem::file_size(path()), text.size());
}

/// Words that only a later version knows, a number beyond ours, a line that is longer: it is not of ours, however it says so.
TEST_F(AsciiFile, OfALaterVersionThatSaysMoreIsLeftAlone) {
  const auto sealed = [](const std::string& words) {
    return fmt::format("{} #{:08x}", words, crc32(std::as_bytes(std::span{words})));
  };
  ASSERT_EQ(sealed("HIROSCO packet log, version 1"), ascii_version_line(1));
  for (const std::string& words : {std::string{"2 compressed"}, std::string{"2.1"}, std::string{"1 packed"},
                                   std::string{"99999999999"}, "2 " + std::string(500, 'x')}) {
    const std::string text = sealed("HIROSCO packet log, version " + words) + '\n' + line_of(1) + '\n';
    std::ofstream{path(), std::ios::trunc} << text;
    for (const auto access : {DatabaseAccess::Read, DatabaseAccess::Write}) {
      const auto database = open_database(DatabaseStrategy::Ascii, path(), access);
      ASSERT_FALSE(database) << words;
      EXPECT_EQ(database.error().code, ErrorCode::Mismatch) << words;
    }
    EXPECT_EQ(std::filesystem::file_size(path()), text.size()) << words;
  }
}

TEST_F(AsciiFile, WhoseVersionACrashHasCutSaysItWholeWithTheNextRecord) {
  const std::string version = ascii_version_line() + '\n';
  for (std::size_t cut = 0; cut <= version.size(); ++cut) {
    std::ofstream{path(), std::ios::trunc} << version.substr(0, cut);
    ASSERT_TRUE((*open_database(DatabaseStrategy::Ascii, path()))->append(batch_of(1, 1))) << cut;
    std::ifstream file{path()};
    const std::string text{std::istreambuf_iterator{file}, {}};
    EXPECT_EQ(text, version + line_of(1, 0) + '\n') << cut;
  }
}

/// As `cat log.log log.2.log` makes it.
TEST_F(AsciiFile, WithAPieceOfAnotherVersionBehindOneOfOursHasNothingOfThat) {
  std::ofstream{path()} << ascii_version_line() << '\n'
                        << line_of(1) << '\n'
                        << ascii_version_line(2) << '\n'
                        << line_of(2) << '\n'
                        << ascii_version_line() << '\n'
                        << line_of(3) << '\n';
  const auto page = (*open_database(DatabaseStrategy::Ascii, path(), DatabaseAccess::Read))->read({});
  EXPECT_THAT(numbers_of(*page), ElementsAre(1, 3));
  EXPECT_EQ(page->damaged, 2U);
}

/// What a file system leaves of octets that a loss of power kept from the disk.
TEST_F(AsciiFile, CountsALineOfZeros) {
  std::ofstream{path()} << line_of(1) << '\n' << std::string(100, '\0') << '\n' << line_of(2) << '\n';
  const auto page = (*open_database(DatabaseStrategy::Ascii, path(), DatabaseAccess::Read))->read({});
  EXPECT_THAT(numbers_of(*page), ElementsAre(1, 2));
  EXPECT_EQ(page->damaged, 1U);
}

TEST_F(AsciiFile, WhoseVersionLineIsDamagedKeepsItsRecords) {
  std::string line = ascii_version_line(1);
  line[line.find('1')] = '2';
  EXPECT_EQ(version_from_ascii(line), std::nullopt);
  std::ofstream{path()} << line << '\n' << line_of(1) << '\n';
  const auto page = (*open_database(DatabaseStrategy::Ascii, path(), DatabaseAccess::Read))->read({});
  EXPECT_THAT(numbers_of(*page), ElementsAre(1));
  EXPECT_EQ(page->damaged, 1U);
}

TEST_F(AsciiFile, SurvivesNoiseInItsFile) {
  std::mt19937 random{7};
  std::ofstream file{path(), std::ios::binary};
  for (int i = 0; i < 400'000; ++i) file.put(static_cast<char>(i > 100'000 && i < 350'000 ? 'x' : random()));
  file << '\n' << line_of(9) << '\n';
  file.close();
  const auto page = (*open_database(DatabaseStrategy::Ascii, path(), DatabaseAccess::Read))->read({});
  ASSERT_TRUE(page);
  EXPECT_THAT(numbers_of(*page), ElementsAre(9));
  EXPECT_GT(page->damaged, 0U);
}

TEST_F(AsciiFile, ReportsAFullDiskAndStoresNothingAfterwards) {
  std::filesystem::create_symlink("/dev/full", path());
  auto database = open_database(DatabaseStrategy::Ascii, path());
  ASSERT_TRUE(database);
  const auto stored = (*database)->append(batch_of(1, 1));
  ASSERT_FALSE(stored);
  EXPECT_EQ(stored.error().value, ENOSPC);
  EXPECT_FALSE((*database)->append(batch_of(2, 2)));
}

}  // namespace
}  // namespace hirosco::supervisor
