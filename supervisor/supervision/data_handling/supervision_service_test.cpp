// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/supervision_service.hpp"

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

/// ST[129] of the supervisor's own subsystem: who answers what, and who is judged as asking.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using pus::FailureCode;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;
namespace st129 = pus::st129;

struct SupervisionServiceTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    start_all(Operational);
    start_supervisor();
    routed_services.clear();
  }
  static std::vector<std::byte> packet_of(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data,
                                          std::uint16_t source) {
    std::vector<std::byte> octets(pus::max_telecommand_octets);
    const auto packet = pus::write_telecommand(
        octets, {.apid = apid, .ack = pus::ack_all, .service = service, .subtype = subtype, .source = source}, data);
    octets.resize(packet.value().size());
    return octets;
  }
  void ask(std::uint8_t subtype, Octets data, const Origin& origin, std::uint16_t source) {
    parts.telecommands.take(
        {.packet = packet_of(supervisor_apid, st129::service_type, subtype, data, source), .origin = origin});
    own_step();
  }
  /// Whether a ping of ARM would be permitted, as ST[129] answers it; empty: it does not answer.
  std::optional<bool> may_ping(const Origin& origin, std::uint16_t source) {
    last_routed.erase(st129::service_type);
    ask(st129::permission_question, packet_of(arm, 17, 1, {}, source), origin, source);
    const auto answer = last_routed.find(st129::service_type);
    if (answer == last_routed.end() || answer->second.size() != 7) return std::nullopt;
    return answer->second[4] == std::byte{1};
  }
};

TEST_F(SupervisionServiceTest, IsTheServiceThatTheTablesHave) {
  EXPECT_EQ(parts.supervision.type(), st129::service_type);
  EXPECT_EQ(&parts.supervision.kind(), &st129::service_kind);
}

TEST_F(SupervisionServiceTest, HandsAQuestionToWhoAnswersItAndRefusesOneThatNobodyAnswers) {
  SupervisionService service{parts.own};
  std::vector<std::pair<std::uint32_t, std::size_t>> asked;
  service.answers(st129::mode_question,
                  [&](const pus::Request& request, Octets data) { asked.emplace_back(request.id, data.size()); });
  const std::array data{std::byte{7}, std::byte{8}};
  for (const std::uint8_t subtype : {st129::mode_question, st129::plan_question}) {
    const auto packet = packet_of(supervisor_apid, st129::service_type, subtype, data, 0);
    const auto telecommand = pus::TelecommandView::parse(packet);
    ASSERT_TRUE(telecommand);
    service.handle(*telecommand, pus::request_of(*telecommand));
  }
  ASSERT_EQ(asked.size(), 1U);
  EXPECT_EQ(asked.front().second, data.size());
  own_step();
  const auto& verdict = last_routed.at(1);
  ASSERT_GE(verdict.size(), 6U);
  OctetReader reader{Octets{verdict}.subspan(4)};
  EXPECT_EQ(reader.get<std::uint16_t>(), static_cast<std::uint16_t>(FailureCode::UnknownSubtype));
}

TEST_F(SupervisionServiceTest, AnswersAtOnceAndSendsNobodyAnything) {
  EXPECT_EQ(may_ping(Origin::ground(), 7), true);
  EXPECT_THAT(texts(arm), IsEmpty());
}

TEST_F(SupervisionServiceTest, JudgesWhoAsksByItsOwnSourceIdAndNobodyByAnothers) {
  ASSERT_EQ(may_ping(Origin::ground(), 7), true);
  // HAND is no client of the ground: what its descriptor does not let it ask of ARM is not permitted to it.
  EXPECT_NE(may_ping(Origin::subsystem(hand), hand), true);
  EXPECT_EQ(may_ping(Origin::ground(), hand), std::nullopt) << "refused: that id is HAND's";
}

TEST(OriginOf, IsWhoHasTheSourceId) {
  const auto mission = parts_mission();
  EXPECT_TRUE(Origin::of(0, mission).is_ground());
  EXPECT_TRUE(Origin::of(99, mission).is_ground());
  EXPECT_TRUE(Origin::of(supervisor_apid, mission).is_supervisor());
  EXPECT_TRUE(Origin::of(arm, mission).is_subsystem());
  EXPECT_EQ(Origin::of(arm, mission).apid(), arm);
}

}  // namespace
}  // namespace hirosco::supervisor
