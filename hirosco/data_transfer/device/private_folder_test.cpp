// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/private_folder.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "hirosco/utilities/os/file_descriptor.hpp"

namespace hirosco {
namespace {

namespace fs = std::filesystem;

/// The group is the test's own: others need rights that it may not have.
struct PrivateFolder : ::testing::Test {
  std::string root = (fs::temp_directory_path() / "hirosco-private-XXXXXX").string();
  std::string folder;
  std::uint32_t group = ::getegid();
  GroupRange nobody{};
  mode_t mask_before{0};
  void SetUp() override {
    ASSERT_NE(::mkdtemp(root.data()), nullptr);
    folder = root + "/device";
    mask_before = ::umask(0027);
  }
  void TearDown() override {
    ::umask(mask_before);
    fs::remove_all(root);
  }
  [[nodiscard]] static int rights_of(const std::string& place) {
    return static_cast<int>(fs::symlink_status(place).permissions());
  }
  static void make_file(const std::string& place) {
    const OpenInPrivate opening{place};
    EXPECT_TRUE(FileDescriptor{::open(place.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, opening.mode())});
  }
};

TEST_F(PrivateFolder, IsMadeForTwoAndShutToAllOthersWhateverTheMask) {
  ASSERT_TRUE(make_private_folder(folder, group, nobody));
  EXPECT_EQ(rights_of(folder), 0770);
  EXPECT_TRUE(is_private_folder(folder, group));
  EXPECT_FALSE(is_private_folder(folder, group + 1));
  EXPECT_TRUE(make_private_folder(folder, group, nobody)) << "again, as one that is there already";
  EXPECT_FALSE(make_private_folder(root + "/no/device", group, nobody)) << "no way up to it is made";
}

TEST_F(PrivateFolder, IsNeverAFolderThatOthersAreIn) {
  for (const mode_t open : {0777U, 01777U, 0755U, 0750U, 0700U}) {
    ASSERT_EQ(::mkdir(folder.c_str(), 0700), 0);
    ASSERT_EQ(::chmod(folder.c_str(), open), 0);
    EXPECT_EQ(make_private_folder(folder, group, {group, group}).error().code, ErrorCode::Mismatch);
    EXPECT_EQ(rights_of(folder), static_cast<int>(open)) << "it is left as it was";
    fs::remove(folder);
  }
}

TEST_F(PrivateFolder, OfAGroupOfTheSameFlightIsGivenToAnother) {
  ASSERT_TRUE(make_private_folder(folder, group, nobody));
  EXPECT_EQ(make_private_folder(folder, group + 1, nobody).error().code, ErrorCode::Mismatch) << "somebody else's";
  // Giving it to a group that is not ours needs a right: what is looked at is that it is tried.
  const auto given = make_private_folder(folder, group + 1, {group, group + 1});
  EXPECT_TRUE(given || given.error().code == ErrorCode::SystemFailure);
  EXPECT_EQ(given.has_value(), is_private_folder(folder, group + 1));
  EXPECT_EQ(rights_of(folder) & 07, 0);
}

TEST_F(PrivateFolder, IsNoLinkToOneAndNoFile) {
  ASSERT_EQ(::mkdir((root + "/elsewhere").c_str(), 0755), 0);
  ASSERT_EQ(::chmod((root + "/elsewhere").c_str(), 0755), 0);
  fs::create_symlink(root + "/elsewhere", folder);
  EXPECT_EQ(make_private_folder(folder, group, {group, group}).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(make_private(folder, group).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(rights_of(root + "/elsewhere"), 0755);
  fs::remove(folder);
  make_file(folder);
  EXPECT_EQ(make_private(folder, group).error().code, ErrorCode::Mismatch);
}

TEST_F(PrivateFolder, HasInItWhatBothMayOpenAndElsewhereTheMaskHolds) {
  ASSERT_TRUE(make_private_folder(folder, group, nobody));
  make_file(folder + "/frames");
  EXPECT_EQ(rights_of(folder + "/frames"), 0666) << "whoever of the two made it";
  make_file(root + "/frames");
  EXPECT_EQ(rights_of(root + "/frames"), 0600);
  { const FileDescriptor file{::open((folder + "/other").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)}; }
  EXPECT_EQ(rights_of(folder + "/other"), 0640) << "the mask is back";
}

}  // namespace
}  // namespace hirosco
