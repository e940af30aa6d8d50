// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/subscriber.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/subsystem/service_loop/requester.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// What a subsystem hears of another one, from its author's words to the values in their hands.
namespace hirosco {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::hex;
using ::testing::IsEmpty;
using testing::read_descriptor;
using testing::Rig;
namespace st129 = pus::st129;

constexpr const char* heard_bell_descriptor = R"(<Subsystem name="BELL" id="11">
  <Parameters>
    <StructRef name="SWING" id="0" type="STRUCT">
      <ParamRef name="ANGLE" id="100" type="FLOAT"/>
      <ParamRef name="COUNTS" id="101" type="UINT16" count="2"/>
    </StructRef>
    <ParamRef name="MUTED" id="102" type="BOOL"/>
    <ParamRef name="PITCH" id="103" type="DOUBLE" writable="Operational" minimum="0" maximum="1"/>
    <ParamRef name="OWNER" id="104" type="TEXT" octets="6" writable="Operational"/>
  </Parameters>
  <Configuration name="ONE" id="1" sampling_us="1000">
    <HKService id="4900" interval="10"><SampledOnce><ParamRef name="SWING"/><ParamRef name="MUTED"/></SampledOnce></HKService>
    <EventService>
      <Event name="CRACKED" id="4901" severity="medium"><Argument name="DEPTH" type="DOUBLE"/><Argument name="AT" type="UINT8" count="2"/></Event>
    </EventService>
  </Configuration>
</Subsystem>)";
constexpr const char* hearing_porter_descriptor = R"(<Subsystem name="PORTER" id="10">
  <Subscribes subsystem="BELL" housekeeping="4900" events="CRACKED"/>
  <Commands subsystem="BELL" sets="PITCH OWNER" reads="SWING" housekeeping="4900" events="CRACKED"/>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";

struct Swing {
  float angle;
  std::array<std::uint16_t, 2> counts;
  bool muted;
};

struct HearingPorter : Subsystem {
  Subscription<Swing> swing{"BELL", "4900"};
  EventSubscription<double, std::array<std::uint8_t, 2>> cracked{"BELL", "CRACKED"};
  Request<double> set_pitch{"BELL", Ask::SetValue, "PITCH"};
  Request<std::string_view> set_owner{"BELL", Ask::SetValue, "OWNER"};
  Request<> read_swing{"BELL", Ask::ReadValue, "SWING"};
  Request<> enable{"BELL", Ask::EnableHousekeeping, "4900"};
  Request<> disable{"BELL", Ask::DisableHousekeeping, "4900"};
  Request<> one_shot{"BELL", Ask::OneShotHousekeeping, "4900"};
  Request<std::uint32_t> interval{"BELL", Ask::SetInterval, "4900"};
  Request<> silence{"BELL", Ask::DisableEvent, "CRACKED"};
  Request<> tell{"BELL", Ask::EnableEvent, "CRACKED"};
  std::vector<std::string> heard;
  std::optional<std::pair<float, std::array<std::uint16_t, 2>>> read;

  Result<Step> software_init() override {
    use_subscription(swing, [this](const Swing& value) {
      heard.push_back(std::to_string(static_cast<int>(value.angle * 10)) + " " + std::to_string(value.counts[0]) + " " +
                      std::to_string(value.counts[1]) + (value.muted ? " muted" : ""));
    });
    use_subscription(cracked, [this](const double& depth, const std::array<std::uint8_t, 2>& at) {
      heard.push_back("cracked " + std::to_string(static_cast<int>(depth * 10)) + " at " + std::to_string(at[0]) + "," +
                      std::to_string(at[1]));
    });
    const auto nothing = [](const RequestReport&) {};
    for (RequestPort* port :
         std::array<RequestPort*, 8>{&set_pitch, &set_owner, &enable, &disable, &one_shot, &interval, &silence, &tell})
      use_request(*port, nothing);
    use_request(read_swing, [this](const RequestReport& report) {
      struct Value {
        float angle;
        std::array<std::uint16_t, 2> counts;
      };
      if (const auto value = value_in<Value>(report)) read = {value->angle, value->counts};
    });
    return done;
  }
  using Subsystem::request;
  using Subsystem::subscribe;
  using Subsystem::unsubscribe;
};

struct Hearing : ::testing::Test {
  HearingPorter porter;
  Rig rig{porter, read_descriptor(hearing_porter_descriptor, {heard_bell_descriptor})};

  /// What it asked the supervisor since this was asked last: subtype and data.
  std::vector<std::pair<int, std::string>> asked() {
    std::vector<std::pair<int, std::string>> all;
    for (const testing::Asked& each : std::exchange(rig.asked, {}))
      if (each.apid == 1) {
        all.emplace_back(each.subtype, hex(each.data));
        last = each;
        requests.push_back(each);
      }
    return all;
  }
  void granted() {
    for (const testing::Asked& each : std::exchange(requests, {})) rig.verify(each, 7);
    rig.service();
  }
  void brought_up() {
    rig.bring_to(State::PreOperational);
    asked();
    granted();
  }
  static std::vector<std::byte> octets(std::initializer_list<int> values) {
    std::vector<std::byte> all;
    for (const int value : values) all.push_back(static_cast<std::byte>(value));
    return all;
  }
  std::vector<testing::Asked> requests;
  testing::Asked last{};
};

TEST_F(Hearing, AsksTheSupervisorForEachAfterSoftwareInitUnderItsOwnId) {
  rig.bring_to(State::PreOperational);
  EXPECT_THAT(asked(), ElementsAre(std::pair(8, "000b011324"), std::pair(8, "000b021325")));
  EXPECT_EQ(last.source, 10);
  EXPECT_EQ(last.service, 129);
  EXPECT_FALSE(porter.swing.active());
  granted();
  EXPECT_TRUE(porter.swing.active());
  EXPECT_TRUE(porter.cracked.active());
  rig.advance(std::chrono::minutes{1});
  rig.service();
  EXPECT_THAT(asked(), IsEmpty()) << "it was told that it is so";
}

TEST_F(Hearing, AsksAgainUntilItIsAnsweredAndNoMoreOnceItWasRefused) {
  rig.bring_to(State::PreOperational);
  EXPECT_EQ(asked().size(), 2U);
  rig.service();
  EXPECT_THAT(asked(), IsEmpty());
  rig.advance(Subscriber::patience);
  rig.service();
  EXPECT_EQ(asked().size(), 2U) << "neither was answered";
  const std::array code{std::byte{0}, std::byte{18}};
  for (const testing::Asked& each : std::exchange(requests, {})) rig.verify(each, 2, code);
  rig.advance(2 * Subscriber::patience);
  rig.service();
  EXPECT_THAT(asked(), IsEmpty());
  EXPECT_FALSE(porter.swing.active());
}

TEST_F(Hearing, GetsValuesAsItsOwnTypes) {
  brought_up();
  rig.answer(11, 3, 25, octets({0x13, 0x24, 0x3f, 0, 0, 0, 0, 7, 1, 0, 9}), 0);
  rig.answer(11, 5, 3, octets({0x13, 0x25, 0x3f, 0xe0, 0, 0, 0, 0, 0, 0, 4, 5}), 10);
  rig.service();
  EXPECT_THAT(porter.heard, ElementsAre("5 7 256 muted", "cracked 5 at 4,5"));
  EXPECT_EQ(porter.swing.value().counts[1], 256);
  EXPECT_EQ(porter.swing.received(), 1U);
  EXPECT_EQ(porter.cracked.received(), 1U);
}

TEST_F(Hearing, TakesNothingOfAnotherFormOfAnotherSourceOrThatIsForTheGround) {
  brought_up();
  rig.answer(11, 3, 25, octets({0x13, 0x24, 0x3f, 0, 0, 0, 0, 7, 1, 0, 9, 9}), 0);  // an octet more
  rig.answer(11, 3, 25, octets({0x13, 0x24, 0x3f}), 0);
  rig.answer(11, 3, 25, octets({0x13}), 0);
  rig.answer(11, 3, 25, octets({0x13, 0x29, 0x3f, 0, 0, 0, 0, 7, 1, 0, 9}), 0);  // another structure
  rig.answer(12, 3, 25, octets({0x13, 0x24, 0x3f, 0, 0, 0, 0, 7, 1, 0, 9}), 0);  // of somebody else
  rig.answer(11, 5, 3, octets({0x13, 0x25, 0x3f, 0xe0, 0, 0, 0, 0, 0, 0, 4, 5}), 0);  // the report to the ground
  rig.service();
  EXPECT_THAT(porter.heard, IsEmpty());
  EXPECT_EQ(porter.swing.received(), 2U);
  EXPECT_EQ(porter.swing.unreadable(), 2U) << "the ground may have added a parameter";
}

TEST_F(Hearing, EndsAndBeginsAsTheAuthorSays) {
  brought_up();
  ASSERT_TRUE(porter.unsubscribe(porter.swing));
  rig.service();
  EXPECT_THAT(asked(), ElementsAre(std::pair(9, "000b011324")));
  rig.answer(11, 3, 25, octets({0x13, 0x24, 0x3f, 0, 0, 0, 0, 7, 1, 0, 9}), 0);
  rig.service();
  EXPECT_THAT(porter.heard, IsEmpty()) << "what was on its way";
  granted();
  EXPECT_FALSE(porter.swing.active());
  ASSERT_TRUE(porter.subscribe(porter.swing));
  rig.service();
  EXPECT_THAT(asked(), ElementsAre(std::pair(8, "000b011324")));
}

TEST_F(Hearing, EndsInSoftwareDeinitAndBeginsAnewWithTheNextInit) {
  brought_up();
  EXPECT_EQ(rig.set_state_now(State::Offline), "1 3 7");
  EXPECT_THAT(asked(), ElementsAre(std::pair(9, "000b011324"), std::pair(9, "000b021325")));
  requests.clear();
  EXPECT_FALSE(porter.swing.active());
  EXPECT_EQ(porter.subscribe(porter.swing).error().code, ErrorCode::NotPermitted);
  rig.bring_to(State::PreOperational);
  EXPECT_EQ(asked().size(), 2U);
}

struct OpenEar final : Subsystem {
  OpenSubscription cracked{std::string{"BELL"}, SubscriptionPort::What::Event, std::string{"CRACKED"}};
  std::vector<std::string> heard;
  Result<Step> software_init() override {
    use_subscription(cracked, [this](Octets values) { heard.push_back(hex(values)); });
    return done;
  }
};

TEST(OpenSubscriptions, HaveTheOctetsOfWhateverIsDeclared) {
  OpenEar ear;
  Rig rig{ear, read_descriptor(hearing_porter_descriptor, {heard_bell_descriptor})};
  rig.bring_to(State::PreOperational);
  ASSERT_EQ(rig.asked.size(), 1U);
  rig.verify(rig.asked[0], 7);
  rig.settle();
  EXPECT_TRUE(ear.cracked.active());
  std::array<std::byte, 2 + 8 + 2> event{};
  OctetWriter{event}.put(std::uint16_t{4901}).put(0.5).put(std::uint8_t{1}).put(std::uint8_t{2});
  rig.answer(11, 5, 3, event, std::uint16_t{10});
  rig.service();
  EXPECT_THAT(ear.heard, ElementsAre("3fe00000000000000102"));
}

TEST(HearingWrongly, IsToldWithAllOtherMistakes) {
  struct Wrong : Subsystem {
    Subscription<std::array<float, 1>> swing{"BELL", "4900"};
    Subscription<Swing> other{"BELL", "4999"};
    EventSubscription<double> gong{"GONG", "CRACKED"};
    Request<float> set_pitch{"BELL", Ask::SetValue, "PITCH"};
    Request<> mute{"BELL", Ask::SetValue, "MUTED"};
    Result<Step> software_init() override {
      use_subscription(swing, {});
      use_subscription(other, {});
      use_subscription(gong, {});
      use_request(set_pitch, {});
      use_request(mute, {});
      return done;
    }
  } wrong;
  Rig rig{wrong, read_descriptor(hearing_porter_descriptor, {heard_bell_descriptor})};
  EXPECT_NE(rig.set_state_now(State::PreOperational), "1 3 7");
  std::string all;
  for (const auto& each : rig.explanations) all += each + "\n";
  EXPECT_THAT(
      all,
      AllOf(HasSubstr("use_subscription BELL 4900: its values are (float), the descriptor of BELL declares (FLOAT, "
                      "UINT16[2], BOOL)"),
            HasSubstr("use_subscription BELL 4999: <Subscribes> does not name it"),
            HasSubstr("use_subscription GONG CRACKED: the descriptor has no <Subscribes> of this subsystem"),
            HasSubstr("use_request BELL PITCH: its arguments are (float), the descriptor of BELL declares (DOUBLE)"),
            HasSubstr("use_request BELL MUTED: <Commands> does not name it in 'sets'")));
}

TEST(HearingWrongly, OfNobodyThatAMissionNamedIsRefused) {
  HearingPorter porter;
  Rig rig{porter, read_descriptor(hearing_porter_descriptor)};
  EXPECT_NE(rig.set_state_now(State::PreOperational), "1 3 7");
  std::string all;
  for (const auto& each : rig.explanations) all += each + "\n";
  EXPECT_THAT(all, AllOf(HasSubstr("use_subscription BELL 4900: no mission says who that is"),
                         HasSubstr("use_request BELL PITCH: no mission says who that is")));
}

/// What a framework's service of the other is asked, octet by octet as the standard has it.
TEST_F(Hearing, AsksTheFrameworksServicesOfTheOther) {
  brought_up();
  const auto sent = [&](const Result<std::uint32_t>& asked) {
    EXPECT_TRUE(asked);
    rig.service();
    const testing::Asked one = rig.asked.back();
    EXPECT_EQ(one.apid, 11);
    return std::to_string(one.service) + "," + std::to_string(one.subtype) + " " + hex(one.data);
  };
  // Parameter ids: subsystem u16, type u8, id u8.
  const auto id = [](Type type, std::uint8_t number) {
    std::array<std::byte, 4> octets;
    OctetWriter{octets}.put(ParameterId{11, type, number}.wire());
    return hex(octets);
  };
  EXPECT_EQ(sent(porter.request(porter.set_pitch, 0.5)), "20,3 01" + id(Type::Double, 103) + "3fe0000000000000");
  EXPECT_EQ(sent(porter.request(porter.set_owner, "Quax")), "20,3 01" + id(Type::Text, 104) + "517561780000");
  EXPECT_EQ(sent(porter.request(porter.read_swing)), "20,1 01" + id(Type::Struct, 0));
  EXPECT_EQ(sent(porter.request(porter.enable)), "3,5 011324");
  EXPECT_EQ(sent(porter.request(porter.disable)), "3,6 011324");
  EXPECT_EQ(sent(porter.request(porter.one_shot)), "3,27 011324");
  EXPECT_EQ(sent(porter.request(porter.interval, 40)), "3,31 01132400000028");
  EXPECT_EQ(sent(porter.request(porter.tell)), "5,5 011325");
  EXPECT_EQ(sent(porter.request(porter.silence)), "5,6 011325");
  EXPECT_EQ(porter.request(porter.set_pitch, 2.0).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(porter.request(porter.set_owner, "too long").error().code, ErrorCode::OutOfRange);
}

TEST_F(Hearing, ReadsAValueOfTheOther) {
  brought_up();
  ASSERT_TRUE(porter.request(porter.read_swing));
  rig.service();
  const testing::Asked asked = rig.asked.back();
  std::vector<std::byte> data{std::byte{1}};
  data.insert(data.end(), asked.data.begin() + 1, asked.data.end());
  for (const int octet : {0x3f, 0, 0, 0, 0, 7, 1, 0}) data.push_back(static_cast<std::byte>(octet));
  rig.answer(11, 20, 2, data);
  rig.verify(asked, 7);
  rig.service();
  ASSERT_TRUE(porter.read);
  EXPECT_EQ(porter.read->first, 0.5F);
  EXPECT_EQ(porter.read->second, (std::array<std::uint16_t, 2>{7, 256}));
}

/// A request of its own to the supervisor is counted in the other half: a report tells the two apart by nothing else.
TEST(Subscriptions, AreCountedInAHalfThatNoRequestIsCountedInHoweverOftenTheyAreAsked) {
  const descriptor::SubsystemDescriptor porter = read_descriptor(hearing_porter_descriptor, {heard_bell_descriptor});
  ChannelPair channel;
  Subscriber subscriber{porter, channel.subsystem_end()};
  Subscription<Swing> swing{"BELL", "4900"};
  subscriber.add(swing, {11, st129::Subscribed::What::Structure, 4900});
  TimePoint now{};
  MessageBuffer buffer;
  for (int times = 0; times < Requester::first_count + 4; ++times, now += Subscriber::patience) {
    subscriber.step(now);
    const auto asked = channel.supervisor_end().receive(buffer);
    ASSERT_TRUE(asked && asked->flow != Flow::None) << times;
    const std::uint32_t count = pus::read_primary_header(asked->message.packet)->request_id % pus::sequence_counts;
    ASSERT_LT(count, Requester::first_count) << times;
  }
}

}  // namespace
}  // namespace hirosco
