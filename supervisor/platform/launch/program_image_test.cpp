// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/program_image.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <string>

#include "supervisor/platform/launch/testing/exit_code.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

namespace fs = std::filesystem;

/// What the tool of the operators says.
[[nodiscard]] std::string sha256sum(const fs::path& file) {
  std::array<char, 65> digest{};
  FILE* const tool = ::popen(("sha256sum '" + file.string() + "'").c_str(), "r");
  if (tool == nullptr || std::fread(digest.data(), 1, 64, tool) != 64) ADD_FAILURE() << "no sha256sum";
  if (tool != nullptr) ::pclose(tool);
  return digest.data();
}

void write_program(const fs::path& file, const std::string& text) {
  std::ofstream{file} << text;
  fs::permissions(file, fs::perms::owner_all);
}

[[nodiscard]] int exit_code_of(const ProgramImage& image) {
  ProcessStart start;
  start.executable = image.file().string();
  start.image = image.descriptor();
  if (image.interpreter()) start.inherited = {{image.descriptor(), 6}};
  return supervisor::testing::exit_code_of(start);
}

TEST(ProgramImageTest, HasTheDigestThatTheOperatorsToolTells) {
  for (const char* file : {"/bin/true", "/bin/sh"}) {
    const auto image = ProgramImage::read(file);
    ASSERT_TRUE(image) << image.error().text;
    EXPECT_EQ(image->digest(), sha256sum(file));
    EXPECT_EQ(image->octets(), fs::file_size(file));
    EXPECT_FALSE(image->interpreter());
  }
}

TEST(ProgramImageTest, WhatWasHashedIsWhatIsExecutedWhateverBecomesOfTheFile) {
  const TestFolder folder;
  const fs::path file = folder.path() / "program";
  fs::copy_file("/bin/true", file);
  const auto image = ProgramImage::read(file);
  ASSERT_TRUE(image) << image.error().text;
  EXPECT_EQ(exit_code_of(*image), 0);
  fs::copy_file("/bin/false", file, fs::copy_options::overwrite_existing);
  EXPECT_EQ(exit_code_of(ProgramImage::read(file).value()), 1) << "the other one that the file is now";
  EXPECT_EQ(exit_code_of(*image), 0);
  fs::remove(file);
  EXPECT_EQ(exit_code_of(*image), 0);
}

TEST(ProgramImageTest, OfAScriptIsReadByItsInterpreterToo) {
  const TestFolder folder;
  const fs::path file = folder.path() / "script";
  write_program(file, "#!/bin/sh\nexit 7\n");
  const auto image = ProgramImage::read(file);
  ASSERT_TRUE(image) << image.error().text;
  EXPECT_TRUE(image->interpreter());
  write_program(file, "#!/bin/sh\nexit 8\n");
  EXPECT_EQ(exit_code_of(*image), 7);
}

TEST(ProgramImageTest, NobodyWhoHoldsItCanChangeIt) {
  const auto image = ProgramImage::read("/bin/true").value();
  EXPECT_EQ(::pwrite(image.descriptor(), "x", 1, 0), -1);
  EXPECT_EQ(::ftruncate(image.descriptor(), 0), -1);
  EXPECT_EQ(::ftruncate(image.descriptor(), 1 << 24), -1);
  EXPECT_EQ(::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, image.descriptor(), 0), MAP_FAILED);
  EXPECT_EQ(::fcntl(image.descriptor(), F_ADD_SEALS, F_SEAL_FUTURE_WRITE), -1);
}

TEST(ProgramImageTest, WhatIsNoExecutableIsRefused) {
  const TestFolder folder;
  const auto why = [&](const char* name) { return ProgramImage::read(folder.path() / name).error().code; };
  EXPECT_EQ(why("nothing"), ErrorCode::NotFound);
  EXPECT_EQ(why(""), ErrorCode::InvalidArgument) << "a folder";
  write_program(folder.path() / "empty", "");
  EXPECT_EQ(why("empty"), ErrorCode::InvalidArgument);
  std::ofstream{folder.path() / "text"} << "#!/bin/sh\n";
  EXPECT_EQ(why("text"), ErrorCode::NotPermitted);
  ASSERT_EQ(::mkfifo((folder.path() / "pipe").c_str(), 0700), 0);
  EXPECT_EQ(why("pipe"), ErrorCode::InvalidArgument) << "and it is not waited for";
}

}  // namespace
}  // namespace hirosco::supervisor
