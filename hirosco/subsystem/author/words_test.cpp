// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// Switches and words as parameters: from the descriptor to the author, to telemetry, and back by telecommand.
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Rig;
using ::testing::StartsWith;

constexpr std::string_view camera_descriptor = R"(<Subsystem name="CAMERA" id="12">
  <Enumeration name="FILTERS"><Text value="1">red</Text><Text value="2">pale green</Text></Enumeration>
  <Parameters>
    <StructRef name="SHUTTER" id="1" type="STRUCT" writable="PreOperational">
      <ParamRef name="OPEN" id="7" type="BOOL"/>
      <ParamRef name="LABEL" id="7" type="TEXT" octets="4"/>
    </StructRef>
    <StructRef name="STATUS" id="0" type="STRUCT">
      <ParamRef name="LIT" id="0" type="BOOL"/>
      <ParamRef name="NOTE" id="1" type="TEXT" octets="8"/>
    </StructRef>
    <ParamRef name="ON" id="1" type="BOOL" init="true" writable="PreOperational Operational"/>
    <ParamRef name="TITLE" id="2" type="TEXT" octets="6" init="night" writable="PreOperational Operational"/>
    <ParamRef name="FILTER" id="3" type="UINT8" enumeration="FILTERS" init="red" minimum="1" maximum="2" writable="PreOperational"/>
  </Parameters>
  <FunctionService/>
  <Configuration name="PLAIN" id="1" priority="80" sampling_us="500">
    <HKService id="4711" interval="1"><SampledOnce>
      <ParamRef name="STATUS"/><ParamRef name="TITLE"/><ParamRef name="ON"/></SampledOnce></HKService>
  </Configuration>
  <Configuration name="DAY" id="2" priority="80" sampling_us="500">
    <Set parameter="TITLE" value="day"/><Set parameter="FILTER" value="pale green"/><Set parameter="NOTE" value="by day"/>
  </Configuration>
</Subsystem>
)";

struct Camera final : Subsystem {
  struct Status {
    bool lit;
    Text<8> note;
  };
  struct Shutter {
    bool open;
    Text<4> label;
  };
  Parameter<Shutter> shutter;
  Parameter<Status> status;
  Parameter<bool> on;
  Parameter<Text<6>> title;
  Parameter<std::uint8_t> filter;
  std::string seen_by_configure;

  Result<Step> software_init() override {
    publish("SHUTTER", shutter);
    publish("STATUS", status);
    publish("ON", on);
    publish("TITLE", title);
    publish("FILTER", filter);
    return done;
  }
  Result<> configure(const descriptor::Configuration&) override {
    seen_by_configure = std::string{title.load().view()} + "/" + std::string{status.load().note.view()};
    return ok();
  }
  Result<> operational(const Cycle&) noexcept override {
    status.store({on.load(), "dusk"});
    return ok();
  }
};

std::vector<std::byte> write_of(Type type, std::uint8_t id, std::string_view octets) {
  std::vector<std::byte> data(5 + octets.size());
  OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{12, type, id}.wire()).put(std::as_bytes(std::span{octets}));
  return data;
}

class SwitchesAndWords : public ::testing::Test {
 protected:
  [[nodiscard]] std::string written(Type type, std::uint8_t id, std::string_view octets) {
    const auto sent = rig.send(20, 3, write_of(type, id, octets));
    rig.settle();
    return rig.outcome(sent);
  }
  Camera camera;
  Rig rig{camera, std::string{camera_descriptor}};
};

TEST_F(SwitchesAndWords, BeginAsTheDescriptorSays) {
  rig.set_state_now(State::PreOperational);
  EXPECT_TRUE(camera.on.load());
  EXPECT_EQ(camera.title.load(), "night");
  EXPECT_EQ(camera.filter.load(), 1) << "an enumeration's value by its name";
  EXPECT_TRUE(camera.status.load().note.empty());
}

TEST_F(SwitchesAndWords, AreSetByTelecommandAndReportedAsTheyWereSent) {
  using namespace std::string_view_literals;
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(written(Type::Text, 2, "caf\xC3\xA9\0"sv), "1 3 7");
  EXPECT_EQ(camera.title.load(), "caf\xC3\xA9");
  EXPECT_EQ(written(Type::Bool, 1, "\0"sv), "1 3 7");
  EXPECT_FALSE(camera.on.load());
  const auto asked = write_of(Type::Text, 2, {});
  rig.send(20, 1, asked);
  rig.settle();
  EXPECT_THAT(rig.reports(20, 2), ElementsAre(testing::hex(write_of(Type::Text, 2, "caf\xC3\xA9\0"sv))));
}

TEST_F(SwitchesAndWords, OtherOctetsThanTheirsAreRefused) {
  using namespace std::string_view_literals;
  rig.set_state_now(State::PreOperational);
  const std::string refused = "1 4:0105";
  for (const std::string_view wrong : {"\x02"sv, "\xFF"sv})
    EXPECT_THAT(written(Type::Bool, 1, wrong), StartsWith(refused)) << testing::hex(std::as_bytes(std::span{wrong}));
  for (const std::string_view wrong : {"ab\0cde"sv, "abcde\xC3"sv, "\xFFzzzzz"sv})
    EXPECT_THAT(written(Type::Text, 2, wrong), StartsWith(refused)) << testing::hex(std::as_bytes(std::span{wrong}));
  EXPECT_EQ(written(Type::Text, 2, "short"sv), "2:0008") << "not of its length";
  EXPECT_TRUE(camera.on.load());
  EXPECT_EQ(camera.title.load(), "night");
}

TEST_F(SwitchesAndWords, OfAStructureAreSetAndReportedOneByOne) {
  using namespace std::string_view_literals;
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(written(Type::Text, 7, "left"sv), "1 3 7");
  EXPECT_EQ(camera.shutter.load().label, "left");
  EXPECT_FALSE(camera.shutter.load().open);
  EXPECT_EQ(written(Type::Bool, 7, "\x01"sv), "1 3 7");
  EXPECT_EQ(camera.shutter.load().label, "left");
  EXPECT_TRUE(camera.shutter.load().open);
  EXPECT_THAT(written(Type::Bool, 7, "\x02"sv), StartsWith("1 4:0105"));
  rig.send(20, 1, write_of(Type::Text, 7, {}));
  rig.settle();
  EXPECT_THAT(rig.reports(20, 2), ElementsAre(testing::hex(write_of(Type::Text, 7, "left"sv))));
}

TEST_F(SwitchesAndWords, StandInHousekeepingAndAreReadFromIt) {
  rig.bring_to(State::Operational);
  rig.cycle(3);
  rig.service();
  const pus::HousekeepingDecoder decoder{testing::read_descriptor(std::string{camera_descriptor})};
  const auto newest = std::ranges::find_if(rig.telemetry.rbegin(), rig.telemetry.rend(), [](const auto& telemetry) {
    return telemetry.service == 3 && telemetry.subtype == 25;
  });
  ASSERT_NE(newest, rig.telemetry.rend());
  ASSERT_EQ(newest->data.size(), 2U + 1 + 8 + 6 + 1);
  const auto values = decoder.decode(newest->data);
  ASSERT_TRUE(values);
  ASSERT_EQ(values->size(), 4U);
  EXPECT_EQ((*values)[0].name, "STATUS.LIT");
  EXPECT_THAT((*values)[0].texts(), ElementsAre("on"));
  EXPECT_EQ((*values)[0].json(), "[true]");
  EXPECT_THAT((*values)[1].texts(), ElementsAre("'dusk'"));
  EXPECT_EQ((*values)[2].json(), R"(["night"])");
  EXPECT_EQ((*values)[3].json(), "[true]");
}

TEST_F(SwitchesAndWords, OfAConfigurationAreThereBeforeItsAuthorIsAsked) {
  using namespace std::string_view_literals;
  rig.set_state_now(State::PreOperational);
  ASSERT_EQ(written(Type::Text, 2, "own\0\0\0"sv), "1 3 7");
  ASSERT_EQ(written(Type::Bool, 1, "\0"sv), "1 3 7");
  ASSERT_EQ(rig.configure_now(2), "1 3 7");
  EXPECT_EQ(camera.seen_by_configure, "day/by day");
  EXPECT_EQ(camera.filter.load(), 2);
  EXPECT_FALSE(camera.on.load()) << "the configuration does not name it: the telecommand's value stays";
}

TEST_F(SwitchesAndWords, AConfigurationThatDoesNotNameThemLeavesThem) {
  using namespace std::string_view_literals;
  rig.set_state_now(State::PreOperational);
  ASSERT_EQ(written(Type::Text, 2, "own\0\0\0"sv), "1 3 7");
  ASSERT_EQ(rig.configure_now(1), "1 3 7");
  EXPECT_EQ(camera.title.load(), "own");
  EXPECT_EQ(camera.seen_by_configure, "own/");
}

TEST(WordsOfAnotherSize, FailSoftwareInitAndSaySo) {
  std::string text{camera_descriptor};
  text.replace(text.find(R"(octets="8")"), 10, R"(octets="9")");
  Camera camera;
  Rig rig{camera, text};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), StartsWith("1 3 8:0202"));
  ASSERT_FALSE(rig.explanations.empty());
  EXPECT_THAT(rig.explanations.front(), HasSubstr("STATUS.NOTE (member 2): the C++ type is Text<8>, the descriptor "
                                                  "declares TEXT of 9 octets"));
}

}  // namespace
}  // namespace hirosco
