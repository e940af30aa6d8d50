// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/custom_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/requests.hpp"
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
    <Request name="NOTE" subtype="7">
      <Argument name="COLOUR" type="INT16" enumeration="COLOURS"/>
      <Argument name="WORDS" type="TEXT" octets="8"/>
      <Argument name="BOLD" type="BOOL" default="0"/>
      <Argument name="MARKS" type="BOOL" count="2"/>
    </Request>
    <Report name="PAGE" subtype="2"><Field name="NUMBER" type="UINT16"/><Field name="LINE" type="UINT64" count="2"/></Report>
    <Report name="NOTED" subtype="8">
      <Field name="WORDS" type="TEXT" octets="4"/><Field name="COLOUR" type="INT16" enumeration="COLOURS"/>
      <Field name="BOLD" type="BOOL"/><Field name="WEIGHT" type="DOUBLE" unit="kg"/>
    </Report>
  </CustomService>
  <Enumeration name="COLOURS"><Text value="-1">red</Text><Text value="7">green</Text></Enumeration>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";

using Lines = std::array<std::uint64_t, 2>;
enum class Ink : std::int16_t { Red = -1, Green = 7 };
enum class Trouble : std::uint16_t { book_lent = 0x8001 };

struct Librarian : Subsystem {
  CustomService book{"BOOK"};
  std::optional<Call> copying;
  bool lent{false};
  Result<> reported{};
  std::string noted;
  double weight{0.5};

  Result<> offline() override {
    book.on_request("READ_PAGE", [this](std::uint16_t number, const Lines& lines, const Call& call) -> Result<> {
      reported = book.report("PAGE", call, number, Lines{lines[0], ~lines[1]});
      return reported;
    });
    book.on_request(
        "NOTE",
        [this](Ink colour, std::string_view words, bool bold, const std::array<bool, 2>& marks, Call call) -> Result<> {
          noted = std::string{words} + (marks[0] ? " +" : " -") + (marks[1] ? "+" : "-");
          return book.report("NOTED", call, words, colour, bold, weight);
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

TEST_F(OwnService, TakesWordsSwitchesAndNamesAsFunctionsDoAndReportsThem) {
  rig.set_state_now(State::PreOperational);
  const descriptor::Function& note = *rig.descriptor().find_named("NOTE");
  const auto noted = [&](const std::vector<std::optional<Value>>& values) {
    const auto data = pus::encode_request(note, values);
    return data ? ask(7, *data) : std::string{data.error().text};
  };
  EXPECT_EQ(noted({-1, "\u20ac", true, true, false}), "1 3 7");
  EXPECT_EQ(author.noted, "\u20ac +-");
  EXPECT_THAT(rig.reports(200, 8), ElementsAre("0003e282ac"
                                               "ffff"
                                               "01"
                                               "3fe0000000000000"));
  EXPECT_EQ(noted({7, "", std::nullopt, false, true}), "1 3 7") << "BOLD by its default";
  EXPECT_EQ(author.noted, " -+");
  EXPECT_EQ(noted({5, "", true, true, true}), "argument outside its range") << "no colour";
  EXPECT_EQ(noted({7, "nine octets", true, true, true}), "text longer than declared");
}

TEST_F(OwnService, RefusesWordsThatAreDamagedTooLongOrCutOffBeforeItsHandler) {
  rig.set_state_now(State::PreOperational);
  const auto sent = [&](std::string_view digits) {
    std::vector<std::byte> data;
    for (std::size_t i = 0; i < digits.size(); i += 2)
      data.push_back(static_cast<std::byte>(std::stoi(std::string{digits.substr(i, 2)}, nullptr, 16)));
    return ask(7, data);
  };
  EXPECT_EQ(sent("0007"
                 "000161"
                 "00"
                 "0100"),
            "1 3 7");
  EXPECT_EQ(sent("0007"
                 "0001ff"
                 "00"
                 "0100"),
            "1 4:01050000000002")
      << "no UTF-8";
  EXPECT_EQ(sent("0007"
                 "0009616161616161616161"
                 "00"
                 "0100"),
            "1 4:01050000000002")
      << "longer than declared";
  EXPECT_EQ(sent("0006"
                 "000161"
                 "00"
                 "0100"),
            "1 4:01050000000001")
      << "no colour";
  EXPECT_EQ(sent("0007"
                 "000161"
                 "02"
                 "0100"),
            "1 4:01050000000003")
      << "neither on nor off";
  EXPECT_EQ(sent("0007"
                 "000261"
                 "00"
                 "0100"),
            "2:0008")
      << "its length takes what follows";
  EXPECT_EQ(sent("0007"
                 "000161"
                 "00"
                 "010000"),
            "2:0008");
}

TEST_F(OwnService, ReportsWhateverIsSoButNoWordsThatItsDescriptorHasNoRoomFor) {
  rig.set_state_now(State::PreOperational);
  ASSERT_EQ(ask(5), "1 3");
  const Call call = *author.copying;
  author.weight = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(author.book.report("NOTED", call, std::string_view{"ok"}, Ink{5}, false, author.weight));
  EXPECT_EQ(author.book.report("NOTED", call, std::string_view{"fives"}, Ink::Red, false, 1.0).error().code,
            ErrorCode::OutOfRange);
  EXPECT_EQ(author.book.report("NOTED", call, std::string_view{"\xff"}, Ink::Red, false, 1.0).error().code,
            ErrorCode::InvalidArgument);
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
  EXPECT_EQ(author.book.report("COVER", call, std::uint16_t{1}, Lines{}).error().code, ErrorCode::NotFound);
  EXPECT_EQ(author.book.report("PAGE", call, std::uint16_t{1}).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(author.book.report("PAGE", call, 1.0, Lines{}).error().code, ErrorCode::Mismatch);
  CustomService nobodys{"BOOK"};
  EXPECT_EQ(nobodys.report("PAGE", call, std::uint16_t{1}, Lines{}).error().code, ErrorCode::Unavailable);
}

struct Careless final : Librarian {
  CustomService film{"FILM"};
  Result<> offline() override {
    book.on_request("READ_PAGE", [](const std::uint16_t&) -> Result<> { return ok(); });
    book.on_request("NOTE",
                    [](std::uint8_t, std::string_view, bool, const std::array<bool, 2>&) -> Result<> { return ok(); });
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
                         HasSubstr("READ_PAGE: the handler takes 1 (std::uint16_t), the descriptor declares 2 (UINT16, "
                                   "UINT64[2])"),
                         HasSubstr("on_request NOTE: argument 1, COLOUR: the descriptor declares INT16, red|green; the "
                                   "handler takes std::uint8_t, which does not hold every value")));
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
