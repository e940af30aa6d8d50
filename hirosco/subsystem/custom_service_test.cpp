// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/custom_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/rig.hpp"

/// A subsystem's own PUS service, from its descriptor to its reports.
namespace hirosco {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Rig;

constexpr const char* librarian_descriptor = R"(<Subsystem name="LIBRARIAN" id="10">
  <Failure code="0x8001" name="BOOK_LENT"/>
  <CustomService name="BOOK" type="200">
    <Request name="READ_PAGE" subtype="1">
      <Argument name="NUMBER" type="UINT16" minimum="1" maximum="300"/>
      <Argument name="LINES" type="UINT64" count="2" minimum="0" maximum="9007199254740992"/>
    </Request>
    <Request name="CLOSE_BOOK" subtype="3" states="Operational"/>
    <Request name="COPY_BOOK" subtype="5"/>
    <Report name="PAGE" subtype="2"><Field name="NUMBER" type="UINT16"/><Field name="LINE" type="UINT64" count="2"/></Report>
  </CustomService>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";

struct ReadPage {
  std::uint16_t number;
  std::array<std::uint64_t, 2> lines;
};
struct Page {
  std::uint16_t number;
  std::array<std::uint64_t, 2> line;
};
enum class Trouble : std::uint16_t { book_lent = 0x8001 };

struct Librarian : Subsystem {
  CustomService book{"BOOK"};
  std::optional<Call> copying;
  bool lent{false};
  Result<> reported{};

  Result<> offline() override {
    book.on_request("READ_PAGE", [this](const ReadPage& asked, const Call& call) -> Result<> {
      reported = book.report("PAGE", call, Page{asked.number, {asked.lines[0], ~asked.lines[1]}});
      return reported;
    });
    book.on_request("CLOSE_BOOK", [this]() -> Outcome {
      return lent ? refused(Trouble::book_lent, "by Ada", 3) : Outcome{Result<>{}};
    });
    book.on_request("COPY_BOOK", [this](const Call& call) -> Outcome {
      copying = call;
      return running;
    });
    provide(book);
    return ok();
  }
};

struct OwnService : ::testing::Test {
  Librarian author;
  Rig rig{author, librarian_descriptor};

  std::string ask(std::uint8_t subtype, Octets data = {}) {
    const auto sent = rig.send(200, subtype, data);
    rig.settle();
    return rig.outcome(sent);
  }
  static std::vector<std::byte> page(std::uint16_t number, std::uint64_t from, std::uint64_t to) {
    std::vector<std::byte> data(18);
    OctetWriter{data}.put(number).put(from).put(to);
    return data;
  }
};

TEST_F(OwnService, TakesArgumentsAndReportsToWhomAskedWithoutLosingADigit) {
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(ask(1, page(7, 1, 1)), "1 3 7");
  EXPECT_THAT(rig.reports(200, 2), ElementsAre("00070000000000000001fffffffffffffffe"));
  EXPECT_EQ(std::ranges::find(rig.telemetry, 200, &testing::Telemetry::service)->destination, Rig::source);
}

TEST_F(OwnService, RefusesWhatTheDescriptorDoesNotPermit) {
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(ask(1, page(301, 1, 2)), "1 4:01050000000001") << "the first argument is out of range";
  EXPECT_EQ(ask(1, Octets{page(7, 1, 2)}.first(17)), "2:0008");
  EXPECT_EQ(ask(9), "2:0007c809");
  EXPECT_EQ(ask(3), "2:000a03") << "in Operational only";
  EXPECT_THAT(rig.reports(200, 2), IsEmpty());
}

TEST_F(OwnService, CarriesTheAuthorsReasonOfARefusal) {
  rig.bring_to(State::Operational);
  EXPECT_EQ(ask(3), "1 3 7");
  author.lent = true;
  EXPECT_THAT(ask(3), HasSubstr("4:8001ff"));
}

TEST_F(OwnService, EndsARunningRequestOnce) {
  rig.set_state_now(State::PreOperational);
  const auto sent = rig.send(200, 5, {});
  rig.settle();
  EXPECT_EQ(rig.outcome(sent), "1 3");
  author.book.finish(*author.copying);
  author.book.finish(*author.copying);
  author.book.abort(*author.copying, {ErrorCode::Timeout, "", 0});
  rig.settle();
  EXPECT_EQ(rig.outcome(sent), "1 3 7");
}

TEST_F(OwnService, RefusesMoreThanRunAtOnceUntilOneHasEnded) {
  rig.set_state_now(State::PreOperational);
  for (int running = 0; running < 64; ++running) ASSERT_EQ(ask(5), "1 3") << running;
  EXPECT_EQ(ask(5), "2:000b");
  author.book.finish(*author.copying);
  EXPECT_EQ(ask(5), "1 3");
}

TEST_F(OwnService, AbortsWhatStillRunsWhenTheSubsystemGoesDown) {
  rig.bring_to(State::SafeOperational);
  const auto sent = rig.send(200, 5, {});
  rig.settle();
  rig.set_state_now(State::Offline);
  EXPECT_THAT(rig.outcome(sent), HasSubstr("8:")) << "nothing accepted is lost";
  EXPECT_EQ(ask(1, page(7, 1, 2)), "2:000a00") << "Offline is none of its states";
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(ask(1, page(7, 1, 2)), "1 3 7") << "and it works again after that";
}

TEST_F(OwnService, ReportsOnlyWhatTheDescriptorDeclares) {
  rig.set_state_now(State::PreOperational);
  ASSERT_EQ(ask(5), "1 3");
  const Call call = *author.copying;
  EXPECT_EQ(author.book.report("COVER", call, Page{}).error().code, ErrorCode::NotFound);
  EXPECT_EQ(author.book.report("PAGE", call, std::uint16_t{1}).error().code, ErrorCode::Mismatch);
  CustomService nobodys{"BOOK"};
  EXPECT_EQ(nobodys.report("PAGE", call, Page{}).error().code, ErrorCode::Unavailable);
}

struct Careless final : Librarian {
  CustomService film{"FILM"};
  Result<> offline() override {
    book.on_request("READ_PAGE", [](const std::uint16_t&) -> Result<> { return ok(); });
    book.on_request("BURN", []() -> Result<> { return ok(); });
    provide(book);
    provide(film);
    return ok();
  }
};

TEST(OwnServices, AllMistakesOfAnAuthorFailTheSameSoftwareInit) {
  Careless author;
  Rig rig{author, librarian_descriptor};
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.state(), State::Offline);
  std::string all;
  for (const auto& text : rig.explanations) all += text;
  EXPECT_THAT(all, AllOf(HasSubstr("declares no service 'FILM'"), HasSubstr("declares no request 'BURN'"),
                         HasSubstr("without a handler: CLOSE_BOOK"), HasSubstr("without a handler: COPY_BOOK"),
                         HasSubstr("READ_PAGE: the handler takes std::uint16_t, the descriptor declares UINT16, "
                                   "UINT64[2]")));
}

struct Absent final : Subsystem {};

TEST(OwnServices, AServiceThatNobodyProvidesFailsSoftwareInit) {
  Absent author;
  Rig rig{author, librarian_descriptor};
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.state(), State::Offline);
  std::string all;
  for (const auto& text : rig.explanations) all += text;
  EXPECT_THAT(all, HasSubstr("service declared but not provided once: BOOK"));
}

}  // namespace
}  // namespace hirosco
