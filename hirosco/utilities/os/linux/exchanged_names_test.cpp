// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/exchanged_names.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

namespace hirosco {
namespace {

namespace fs = std::filesystem;

TEST(ExchangedNames, OfAFolderAndAFileAreThoseOfEachOther) {
  const fs::path folder = fs::path{::testing::TempDir()} / "exchanged_names";
  fs::create_directories(folder / "one");
  std::ofstream{folder / "two"} << "2";
  ASSERT_TRUE(exchange_names(folder / "one", folder / "two"));
  EXPECT_TRUE(fs::is_directory(folder / "two"));
  EXPECT_TRUE(fs::is_regular_file(folder / "one"));
  const auto nobody = exchange_names(folder / "one", folder / "three");
  ASSERT_FALSE(nobody);
  EXPECT_EQ(nobody.error().code, ErrorCode::SystemFailure);
  EXPECT_EQ(nobody.error().value, ENOENT);
  EXPECT_TRUE(fs::is_regular_file(folder / "one")) << "nothing has gone";
  fs::remove_all(folder);
}

}  // namespace
}  // namespace hirosco
