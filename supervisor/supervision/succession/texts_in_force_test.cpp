// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/succession/texts_in_force.hpp"

#include <gtest/gtest.h>

/// By what a supervisor goes on for one that died, whatever the files say by then.
namespace hirosco::supervisor {
namespace {

using NotedTexts = TextsInForce::Texts;

[[nodiscard]] std::shared_ptr<const std::string> shared_text(std::string words) {
  return std::make_shared<const std::string>(std::move(words));
}
[[nodiscard]] std::map<std::string, std::string> texts_by_file(const NotedTexts& texts) {
  std::map<std::string, std::string> words;
  for (const auto& [file, each] : texts) words[file.string()] = *each;
  return words;
}

struct TextsTest : ::testing::Test {
  std::vector<std::byte> memory = std::vector<std::byte>(1024);
  TextsInForce noted{memory};
  NotedTexts texts{{"arm.xml", shared_text("<Subsystem/>")},
                   {"@hirosco/mission.xml", shared_text("<Mission/>")},
                   {"none.xml", shared_text("")}};
  /// Of who goes on.
  [[nodiscard]] NotedTexts found() { return TextsInForce{memory}.newest(); }
};

TEST_F(TextsTest, AreNoneBeforeTheFirstSupervisor) { EXPECT_TRUE(found().empty()); }

TEST_F(TextsTest, AreThoseOfTheSupervisorBefore) {
  ASSERT_TRUE(noted.note(texts));
  EXPECT_EQ(texts_by_file(found()), texts_by_file(texts));
}

TEST_F(TextsTest, FollowADescriptorThatIsReadAgain) {
  ASSERT_TRUE(noted.note(texts));
  texts["arm.xml"] = shared_text("<Subsystem>\n</Subsystem>");
  ASSERT_TRUE(noted.note(texts));
  EXPECT_EQ(texts_by_file(found()), texts_by_file(texts));
}

TEST_F(TextsTest, AreWrittenOnlyWhereOneIsAnother) {
  ASSERT_TRUE(noted.note(texts));
  const auto before = memory;
  ASSERT_TRUE(noted.note(texts));
  EXPECT_EQ(memory, before);
}

TEST_F(TextsTest, ThatDoNotFitAreNotThereAndNoEarlierOnesEither) {
  ASSERT_TRUE(noted.note(texts));
  texts["arm.xml"] = shared_text(std::string(memory.size(), 'x'));
  EXPECT_FALSE(noted.note(texts));
  EXPECT_TRUE(found().empty());
  texts["arm.xml"] = shared_text("short");
  EXPECT_TRUE(noted.note(texts));
  EXPECT_EQ(found().size(), 3U);
}

TEST_F(TextsTest, AreNoneOnceOneOctetIsDamaged) {
  ASSERT_TRUE(noted.note(texts));
  for (std::size_t i = 0; i < memory.size() / 2; ++i) {
    auto damaged = memory;
    damaged[i] ^= std::byte{0x10};
    const auto words = texts_by_file(TextsInForce{damaged}.newest());
    EXPECT_TRUE(words.empty() || words == texts_by_file(texts)) << i;
  }
}

}  // namespace
}  // namespace hirosco::supervisor
