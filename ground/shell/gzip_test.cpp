// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/shell/gzip.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace hirosco::ground {
namespace {

namespace fs = std::filesystem;

/// What the system's own gzip makes of it; it checks sum and length.
[[nodiscard]] std::optional<std::string> unzipped(const std::string& octets) {
  const fs::path file = fs::path{::testing::TempDir()} / ("zipped_" + std::to_string(::getpid()));
  std::ofstream{file.string() + ".gz", std::ios::binary} << octets;
  const int ended = std::system(("gzip -dc " + file.string() + ".gz > " + file.string()).c_str());
  std::ifstream stream{file, std::ios::binary};
  std::string text{std::istreambuf_iterator<char>{stream}, {}};
  fs::remove(file);
  fs::remove(file.string() + ".gz");
  return ended == 0 ? std::optional{text} : std::nullopt;
}

TEST(Gzip, IsReadBackByTheSystemsGzip) {
  std::minstd_rand random{3};
  for (const std::size_t length : {std::size_t{1024}, std::size_t{4097}, std::size_t{84'000}, most_zipped_octets}) {
    std::string text;
    while (text.size() < length) text += R"({"name":"POSITION[)" + std::to_string(random() % 100) + R"(]","v":null},)";
    text.resize(length);
    const auto octets = zipped(text);
    ASSERT_TRUE(octets) << length;
    EXPECT_LT(octets->size(), length / 2);
    EXPECT_EQ(unzipped(*octets), text) << length;
  }
}

TEST(Gzip, LeavesAloneWhatIsShortOrLongOrDoesNotShrink) {
  EXPECT_FALSE(zipped(std::string(least_zipped_octets - 1, 'a')));
  EXPECT_FALSE(zipped(std::string(most_zipped_octets + 1, 'a')));
  std::minstd_rand random{5};
  std::string noise(5000, '\0');
  for (char& c : noise) c = static_cast<char>(random() >> 8);
  EXPECT_FALSE(zipped(noise));
}

TEST(Gzip, IsTakenByWhoSaysSo) {
  for (const char* yes : {"gzip", "gzip, deflate, br", "br;q=1.0, gzip;q=0.8", "deflate, gzip;q=0.001"})
    EXPECT_TRUE(takes_gzip(yes)) << yes;
  for (const char* no : {"", "br", "identity", "gzip;q=0", "gzip; q=0.000, br", "br;q=1, gzip;q=0"})
    EXPECT_FALSE(takes_gzip(no)) << no;
}

}  // namespace
}  // namespace hirosco::ground
