// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/refusals.hpp"

#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using pus::FailureCode;
using pus::FailureNotice;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct RefusalsTest : PartsTest {
  Refusals refusals{craft, parts.own, parts.traffic};
  const std::vector<std::byte> move = telecommand(arm, 8, 1, call_data("MOVE_TO"));
  const pus::Request request = pus::request_of(pus::TelecommandView::parse(move).value());

  /// Why telecommands were refused, in the words of the log.
  std::vector<std::string> logged() {
    std::vector<std::string> found;
    for (const LogRecord& record : all_of(*store))
      if (record.kind == LogKind::TelecommandRefused) found.emplace_back(record.note.view());
    return found;
  }
  static std::string words(FailureCode code) { return std::string{to_text(code)}; }
};

TEST_F(RefusalsTest, AreLoggedWithTheirReasonAndWhomTheyWereFor) {
  FailureNotice notice{FailureCode::NotPermittedNow};
  refusals.refuse(move, Origin::subsystem(hand), request,
                  notice.because({ErrorCode::NotPermitted, 0, "stopped since this was asked for"}));
  EXPECT_THAT(logged(), ElementsAre(words(FailureCode::NotPermittedNow) + ": stopped since this was asked for"));
  const LogRecord record = all_of(*store).back();
  EXPECT_EQ(record.source, hand);
  EXPECT_EQ(record.peer, arm);
  EXPECT_EQ(record.packet, move);
}

TEST_F(RefusalsTest, NameTheClientThatClaimedANameOnBoard) {
  refusals.refuse(move, Origin::ground(3), request, FailureNotice{FailureCode::ForeignSource});
  refusals.refuse(move, Origin::ground(3), request, FailureNotice{FailureCode::QueueFull});
  EXPECT_THAT(logged(), ElementsAre(words(FailureCode::ForeignSource) + ", client 3", words(FailureCode::QueueFull)));
}

TEST_F(RefusalsTest, OfDamagedPacketsAreToldTenTimesInASecondAndCountedBeyond) {
  const FailureNotice notice{FailureCode::ErrorControl};
  for (int i = 0; i < 15; ++i) refusals.refuse_damaged(move, Origin::ground(), notice);
  EXPECT_THAT(logged(), ::testing::AllOf(SizeIs(10), Each(words(FailureCode::ErrorControl))));
  EXPECT_EQ(parts.traffic.rejections()[static_cast<std::size_t>(FailureCode::ErrorControl)], 5U);
  wait(1s);
  refusals.refuse_damaged(move, Origin::ground(), notice);
  EXPECT_THAT(logged(), SizeIs(11));
}

TEST_F(RefusalsTest, OfTelecommandsThatAreWholeAreNotHeldBackByDamagedOnes) {
  for (int i = 0; i < 15; ++i)
    refusals.refuse_damaged(move, Origin::ground(), FailureNotice{FailureCode::ErrorControl});
  refusals.refuse(move, Origin::ground(), request, FailureNotice{FailureCode::WrongState});
  EXPECT_EQ(logged().back(), words(FailureCode::WrongState));
}

TEST_F(RefusalsTest, AreNotMadeOfIdlePackets) {
  auto idle = move;
  idle[0] |= std::byte{0x07};
  idle[1] = std::byte{0xFF};
  refusals.refuse_damaged(idle, Origin::ground(), FailureNotice{FailureCode::ErrorControl});
  EXPECT_THAT(logged(), IsEmpty());
}

}  // namespace
}  // namespace hirosco::supervisor
