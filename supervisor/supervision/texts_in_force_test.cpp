// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/texts_in_force.hpp"

#include <gtest/gtest.h>

/// By what a supervisor goes on for one that died, whatever the files say by then.
namespace hirosco::supervisor {
namespace {

using Texts = TextsInForce::Texts;

[[nodiscard]] std::shared_ptr<const std::string> text(std::string words) {
  return std::make_shared<const std::string>(std::move(words));
}
[[nodiscard]] std::map<std::string, std::string> words_of(const Texts& texts) {
  std::map<std::string, std::string> words;
  for (const auto& [file, each] : texts) words[file.string()] = *each;
  return words;
}

struct TextsTest : ::testing::Test {
  std::vector<std::byte> memory = std::vector<std::byte>(1024);
  TextsInForce noted{memory};
  Texts texts{{"arm.xml", text("<Subsystem/>")}, {"@hirosco/mission.xml", text("<Mission/>")}, {"none.xml", text("")}};
  /// Of who goes on.
  [[nodiscard]] Texts found() { return TextsInForce{memory}.newest(); }
};

TEST_F(TextsTest, AreNoneBeforeTheFirstSupervisor) { EXPECT_TRUE(found().empty()); }

TEST_F(TextsTest, AreThoseOfTheSupervisorBefore) {
  ASSERT_TRUE(noted.note(texts));
  EXPECT_EQ(words_of(found()), words_of(texts));
}

TEST_F(TextsTest, FollowADescriptorThatIsReadAgain) {
  ASSERT_TRUE(noted.note(texts));
  texts["arm.xml"] = text("<Subsystem>\n</Subsystem>");
  ASSERT_TRUE(noted.note(texts));
  EXPECT_EQ(words_of(found()), words_of(texts));
}

TEST_F(TextsTest, AreWrittenOnlyWhereOneIsAnother) {
  ASSERT_TRUE(noted.note(texts));
  const auto before = memory;
  ASSERT_TRUE(noted.note(texts));
  EXPECT_EQ(memory, before);
}

TEST_F(TextsTest, ThatDoNotFitAreNotThereAndNoEarlierOnesEither) {
  ASSERT_TRUE(noted.note(texts));
  texts["arm.xml"] = text(std::string(memory.size(), 'x'));
  EXPECT_FALSE(noted.note(texts));
  EXPECT_TRUE(found().empty());
  texts["arm.xml"] = text("short");
  EXPECT_TRUE(noted.note(texts));
  EXPECT_EQ(found().size(), 3U);
}

TEST_F(TextsTest, AreNoneOnceOneOctetIsDamaged) {
  ASSERT_TRUE(noted.note(texts));
  for (std::size_t i = 0; i < memory.size() / 2; ++i) {
    auto damaged = memory;
    damaged[i] ^= std::byte{0x10};
    const auto words = words_of(TextsInForce{damaged}.newest());
    EXPECT_TRUE(words.empty() || words == words_of(texts)) << i;
  }
}

}  // namespace
}  // namespace hirosco::supervisor
