// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/dynamics/lines.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <memory>
#include <string_view>

namespace hirosco::tools {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

[[nodiscard]] File file_of(std::string_view text) {
  File file{std::tmpfile(), std::fclose};
  std::fwrite(text.data(), 1, text.size(), file.get());
  std::rewind(file.get());
  return file;
}

TEST(BoundedLines, AreAllThatAFileHasTheLastOneWithOrWithoutItsEnd) {
  for (const std::string_view text : {"one\n\n three \n", "one\n\n three "}) {
    const File file = file_of(text);
    BoundedLines lines{file.get(), 7};
    for (const char* line : {"one", "", " three "}) {
      ASSERT_EQ(lines.next(), BoundedLines::Next::Line);
      EXPECT_EQ(lines.line(), line);
    }
    EXPECT_EQ(lines.next(), BoundedLines::Next::End);
    EXPECT_EQ(lines.next(), BoundedLines::Next::End) << "also when asked again";
  }
}

TEST(BoundedLines, OneThatIsTooLongIsPassedOverAndNotKept) {
  const File file = file_of(std::string(100'000, 'x') + "\n12345678\n1234567\n" + std::string(100'000, 'y'));
  BoundedLines lines{file.get(), 7};
  ASSERT_EQ(lines.next(), BoundedLines::Next::TooLong);
  EXPECT_LT(lines.line().capacity(), 100u) << "it was never whole in memory";
  ASSERT_EQ(lines.next(), BoundedLines::Next::TooLong) << "one octet is too many";
  ASSERT_EQ(lines.next(), BoundedLines::Next::Line);
  EXPECT_EQ(lines.line(), "1234567") << "and as many as there may be are not";
  EXPECT_EQ(lines.next(), BoundedLines::Next::TooLong) << "also the last one, which lacks its end";
  EXPECT_EQ(lines.next(), BoundedLines::Next::End);
}

TEST(BoundedLines, WhatCannotBeReadIsNoEnd) {
  const File folder{std::fopen("/", "r"), std::fclose};
  ASSERT_NE(folder, nullptr);
  BoundedLines lines{folder.get(), 7};
  errno = 0;
  EXPECT_EQ(lines.next(), BoundedLines::Next::Failed);
  EXPECT_EQ(errno, EISDIR);
}

}  // namespace
}  // namespace hirosco::tools
