// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/script_player/script_player.hpp"

#include <gtest/gtest.h>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

namespace hirosco {
namespace {

constexpr std::uint8_t scripts = 210, play = 1, hold = 2, resume = 3, abort_it = 4;
constexpr std::uint16_t begun = 2501, ended = 2502, stopped = 2503;

/// The test plays the supervisor and HELLO.
struct ScriptPlayerTest : ::testing::Test {
  static std::string text_of(const char* file) {
    return descriptor::file_system()(std::filesystem::path{HIROSCO_SOURCE_DIR} / file).value();
  }
  static descriptor::SubsystemDescriptor described() {
    auto player = testing::read_descriptor(text_of("subsystems/script_player/script_player.xml"),
                                           {text_of("subsystems/hello/hello.xml")});
    player.file = HIROSCO_SOURCE_DIR "/subsystems/script_player/script_player.xml";
    return player;
  }
  std::unique_ptr<Subsystem> player = make_script_player();
  testing::Rig rig{*player, described()};

  void SetUp() override {
    rig.bring_to(State::PreOperational);
    for (const State state : {State::SafeOperational, State::Operational}) ASSERT_EQ(rig.set_state_now(state), "1 3 7");
  }
  testing::Sent ask(std::uint8_t subtype, std::string_view name = {}) {
    std::vector<std::byte> data;
    if (subtype == play) {
      data.resize(2 + name.size());
      OctetWriter{data}.put(static_cast<std::uint16_t>(name.size())).put(std::as_bytes(std::span{name}));
    }
    const auto sent = rig.send(scripts, subtype, data);
    settle();
    return sent;
  }
  void settle(int rounds = 3) {
    for (int i = 0; i < rounds; ++i) rig.settle(1);
  }
  /// What went to HELLO last is answered.
  void complete() {
    const testing::Asked asked = rig.asked.back();
    if (asked.service == 20) {
      // One parameter, its id, not moving: four or eight octets of zero.
      std::vector<std::byte> data(asked.data.begin(), asked.data.end());
      data.resize(data.size() + (wide ? 8 : 4));
      rig.answer(asked.apid, 20, 2, data);
    }
    rig.verify(asked, 7);
    settle();
  }
  [[nodiscard]] static std::string words(const std::string& text) {
    return testing::hex(std::as_bytes(std::span{text}));
  }
  bool wide{false};
};

TEST_F(ScriptPlayerTest, PlaysAScriptLineByLineAndEndsWithItsTelecommand) {
  const auto sent = ask(play, "there_and_back");
  EXPECT_EQ(rig.outcome(sent), "1 3");
  EXPECT_EQ(rig.heard(begun), 1);
  ASSERT_EQ(rig.asked.size(), 1U);
  EXPECT_EQ(rig.asked[0].service, 20) << "it looks whether the joint moves";
  complete();
  ASSERT_EQ(rig.asked.size(), 2U);
  EXPECT_EQ(rig.asked[1].service, 8);
  EXPECT_EQ(rig.asked[1].apid, 7);
  EXPECT_EQ(testing::hex(rig.asked[1].data).substr(0, 14), words("MOVE_TO"));
  complete();
  rig.advance(500ms);
  settle();
  complete();  // at rest
  rig.advance(600ms);
  settle();
  ASSERT_EQ(rig.asked.size(), 4U);
  complete();  // back
  wide = true;
  settle();
  complete();
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
  EXPECT_EQ(rig.heard(ended), 1);
}

TEST_F(ScriptPlayerTest, ARefusalHalfWayEndsItAndReachesWhoPlayedItInWords) {
  const auto sent = ask(play, "TOO_FAR");
  complete();
  const std::array not_acceptable{std::byte{0}, std::byte{13}, std::byte{2}};
  rig.verify(rig.asked.back(), 2, not_acceptable);
  settle();
  EXPECT_EQ(rig.heard(stopped), 1);
  EXPECT_NE(rig.outcome(sent).find(words("line 6: HELLO MOVE_TO: ")), std::string::npos) << rig.outcome(sent);
  EXPECT_EQ(rig.asked.size(), 2U) << "the third is never sent";
}

TEST_F(ScriptPlayerTest, IsHeldResumedAndAborted) {
  const auto sent = ask(play, "TOO_FAR");
  EXPECT_EQ(rig.outcome(ask(hold)), "1 3 7");
  complete();
  EXPECT_EQ(rig.asked.size(), 1U);
  EXPECT_EQ(rig.outcome(ask(resume)), "1 3 7");
  EXPECT_EQ(rig.asked.size(), 2U);
  EXPECT_EQ(rig.outcome(ask(abort_it)), "1 3 7");
  EXPECT_NE(rig.outcome(sent).find(words("aborted in line 6")), std::string::npos) << rig.outcome(sent);
  complete();
  EXPECT_EQ(rig.asked.size(), 2U);
  EXPECT_NE(rig.outcome(ask(abort_it)).find(":8003"), std::string::npos) << "nothing is played";
}

TEST_F(ScriptPlayerTest, PlaysOneAtATimeAndNoneThatItDoesNotHave) {
  EXPECT_NE(rig.outcome(ask(play, "NOWHERE")).find(":8001"), std::string::npos);
  const auto sent = ask(play, "TOO_FAR");
  EXPECT_NE(rig.outcome(ask(play, "THERE_AND_BACK")).find(":8002"), std::string::npos);
  EXPECT_EQ(rig.outcome(sent), "1 3");
}

TEST_F(ScriptPlayerTest, LeavingOperationalEndsTheScript) {
  const auto sent = ask(play, "TOO_FAR");
  EXPECT_EQ(rig.set_state_now(State::SafeOperational), "1 3 7");
  settle();
  EXPECT_NE(rig.outcome(sent).find(words("line 5: its player has left Operational")), std::string::npos)
      << rig.outcome(sent);
  EXPECT_EQ(rig.asked.size(), 1U);
}

TEST(ScriptPlayer, DoesNotBeginWithAScriptThatAsksForWhatItMayNot) {
  auto described = ScriptPlayerTest::described();
  described.commands.front().functions = {"MOVE"};
  described.commands.front().requests.front().name = "MOVE";
  const auto player = make_script_player();
  testing::Rig rig{*player, described};
  EXPECT_NE(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_TRUE(std::ranges::any_of(rig.explanations, [](const std::string& line) {
    return line.find("there_and_back.script:6: ") != std::string::npos;
  }));
}

}  // namespace
}  // namespace hirosco
