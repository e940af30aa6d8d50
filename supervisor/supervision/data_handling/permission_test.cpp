// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/permission.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hirosco/pus/standard_services.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// The rules of acceptance that are the supervisor's (docs/failure-codes.md, decisions 24 and 26), as one table.
namespace hirosco::supervisor {
namespace {

using descriptor::State;
using testing::arm;
using testing::camera;
using testing::hand;

enum : std::size_t { open_mode, narrow_mode };

struct Case {
  const char* says;
  std::uint16_t apid;
  std::uint8_t service;
  std::uint8_t subtype;
  std::vector<std::byte> data;
  const char* outcome;               ///< "ok", "essential", "ok, lifts stop", or code and data of the refusal
  Origin origin{Origin::ground()};
  std::size_t mode{open_mode};
  std::optional<State> state{State::Operational};
  std::uint8_t configuration{0};
  bool link_up{false};               ///< of link 2, which the configuration 2 of the arm requires
  double budget_w{60};               ///< what that configuration draws
};

std::string text_of(const std::expected<Permitted, pus::FailureNotice>& decision) {
  if (!decision) {
    std::string text = std::to_string(static_cast<int>(decision.error().code()));
    for (const std::byte octet : decision.error().data())
      text.append(1, ' ').append(std::to_string(std::to_integer<int>(octet)));
    return text;
  }
  std::string text{decision->essential ? "essential" : "ok"};
  if (decision->releases_stop) text.append(", lifts stop");
  if (decision->reserves_w > 0)
    text.append(", ").append(std::to_string(std::lround(decision->reserves_w))).append(" W");
  return text;
}

std::vector<std::byte> set_state(State state) { return testing::call_data("SET_STATE", static_cast<int>(state)); }
std::vector<std::byte> call(const char* name) { return testing::call_data(name); }

const std::vector<Case> cases{
    // --- addressee, service, subtype ------------------------------------------------------------------------------
    {"an APID that nobody has", 99, 17, 1, {}, "1"},
    {"a subsystem that does not run", arm, 17, 1, {}, "1", Origin::ground(), open_mode, std::nullopt},
    {"the supervisor itself", 1, 17, 1, {}, "essential"},
    {"an unknown service", arm, 99, 1, {}, "6 99"},
    {"verification is no request", arm, 1, 1, {}, "6 1"},
    {"an unknown subtype", arm, 17, 9, {}, "7 17 9"},
    {"the question what is permitted", 1, 129, 1, {}, "essential", Origin::ground(), narrow_mode},
    {"that question to another", arm, 129, 1, {}, "6 129"},
    {"its answer sent as a request", 1, 129, 2, {}, "7 129 2"},
    {"its answer sent as a request to another", arm, 129, 2, {}, "6 129"},
    {"a report sent as a request", arm, 3, 25, {}, "7 3 25"},
    {"another unknown subtype", arm, 8, 2, {}, "7 8 2"},
    {"an unknown subtype of links", arm, 128, 6, {}, "7 128 6", Origin::supervisor()},
    // --- modes ----------------------------------------------------------------------------------------------------
    {"a service that the mode permits", arm, 3, 5, {}, "ok"},
    {"a service that the mode does not permit", arm, 3, 5, {}, "13 2", Origin::ground(), narrow_mode},
    {"a ping is permitted in every mode", arm, 17, 1, {}, "essential", Origin::ground(), narrow_mode},
    {"a function that the mode permits", arm, 8, 1, call("MOVE_TO"), "ok", Origin::ground(), narrow_mode},
    {"the same function of another subsystem", hand, 8, 1, call("MOVE_TO"), "13 2", Origin::ground(), narrow_mode},
    {"a subsystem is bound to the mode like ground", hand, 8, 1, call("MOVE_TO"), "13 2", Origin::subsystem(camera),
     narrow_mode},
    // --- of a subsystem: CAMERA's descriptor declares MOVE_TO of HAND, and MOVE_TO and BRAKE of ARM ------------------
    {"what its descriptor declares", hand, 8, 1, call("MOVE_TO"), "ok", Origin::subsystem(camera)},
    {"what it declares of another one", hand, 8, 1, call("BRAKE"), "18", Origin::subsystem(camera)},
    {"essential or not, it declares it", arm, 8, 1, call("BRAKE"), "essential", Origin::subsystem(camera), narrow_mode},
    {"declared, but outside its states", arm, 8, 1, call("MOVE_TO"), "10 4", Origin::subsystem(camera), open_mode,
     State::SafeOperational},
    {"who declares nothing", arm, 8, 1, call("MOVE_TO"), "18", Origin::subsystem(hand)},
    {"who is not in the mission", arm, 8, 1, call("MOVE_TO"), "18", Origin::subsystem(99)},
    {"its own functions are another's to call", camera, 8, 1, call("MOVE_TO"), "18", Origin::subsystem(camera)},
    {"an unknown function is declared by nobody", arm, 8, 1, call("DANCE"), "18", Origin::subsystem(camera)},
    {"a function without a name", arm, 8, 1, std::vector<std::byte>(5), "18", Origin::subsystem(camera)},
    {"the state of another one", arm, 8, 1, set_state(State::ErrorOperational), "18", Origin::subsystem(camera)},
    {"its configuration", arm, 8, 1, testing::call_data("CONFIGURE", 2), "18", Origin::subsystem(camera)},
    {"its parameters", arm, 20, 1, {}, "18", Origin::subsystem(camera)},
    {"a ping", arm, 17, 1, {}, "18", Origin::subsystem(camera)},
    {"what the supervisor permits", 1, 129, 1, {}, "18", Origin::subsystem(camera)},
    {"the supervisor is not bound to the mode", hand, 8, 1, call("MOVE_TO"), "ok", Origin::supervisor(), narrow_mode},
    {"a mode permits functions, not their service", arm, 8, 1, call("MOVE_TO"), "ok", Origin::ground(), open_mode},
    {"SET_STATE upwards needs the mode", arm, 8, 1, set_state(State::PreOperational), "13 2", Origin::ground(),
     narrow_mode, State::Offline},
    {"CONFIGURE needs the mode", arm, 8, 1, testing::call_data("CONFIGURE", 2), "13 2", Origin::ground(), narrow_mode,
     State::PreOperational},
    // --- states ---------------------------------------------------------------------------------------------------
    {"a function outside its states", arm, 8, 1, call("MOVE_TO"), "10 4", Origin::ground(), open_mode,
     State::SafeOperational},
    {"an unknown function is its addressee's to refuse", arm, 8, 1, call("DANCE"), "ok"},
    {"so it is in a narrow mode", arm, 8, 1, call("DANCE"), "ok", Origin::ground(), narrow_mode},
    {"too short for a function's name: the addressee says so", arm, 8, 1, std::vector<std::byte>(5), "13 2",
     Origin::ground(), narrow_mode},
    // --- the self test, of ST[17] like the ping, is bound to mode and state ----------------------------------------------
    {"a self test in Safe-Operational", arm, 17, 128, {}, "ok", Origin::ground(), open_mode, State::SafeOperational},
    {"a self test elsewhere", arm, 17, 128, {}, "10 5"},
    {"a self test that the mode does not permit",
     arm,
     17,
     128,
     {},
     "13 2",
     Origin::ground(),
     narrow_mode,
     State::SafeOperational},
    {"the outcome of a self test, in any state", arm, 17, 130, {}, "ok"},
    {"that outcome where the mode does not permit it", arm, 17, 130, {}, "13 2", Origin::ground(), narrow_mode},
    {"its report sent as a request", arm, 17, 129, {}, "7 17 129"},
    // --- essential ------------------------------------------------------------------------------------------------
    {"an essential function in a narrow mode", arm, 8, 1, call("BRAKE"), "essential", Origin::ground(), narrow_mode},
    {"an essential function outside its states", arm, 8, 1, call("BRAKE"), "essential", Origin::ground(), narrow_mode,
     State::SafeOperational},
    {"SAFE_ALL", 1, 8, 1, call("SAFE_ALL"), "essential", Origin::ground(), narrow_mode},
    {"to Error-Operational", arm, 8, 1, set_state(State::ErrorOperational), "essential", Origin::ground(), narrow_mode},
    {"to Post-Operational", arm, 8, 1, set_state(State::PostOperational), "essential", Origin::ground(), narrow_mode},
    {"from Operational to Safe-Operational", arm, 8, 1, set_state(State::SafeOperational), "essential",
     Origin::ground(), narrow_mode},
    {"up to Safe-Operational is not essential", arm, 8, 1, set_state(State::SafeOperational), "13 2", Origin::ground(),
     narrow_mode, State::PreOperational},
    {"to Offline by the supervisor", arm, 8, 1, set_state(State::Offline), "essential", Origin::supervisor()},
    {"to Offline by ground", arm, 8, 1, set_state(State::Offline), "ok"},
    // --- links ----------------------------------------------------------------------------------------------------
    {"up to Safe-Operational without the required link", arm, 8, 1, set_state(State::SafeOperational), "14 2",
     Origin::ground(), open_mode, State::PreOperational, 2, false},
    {"the supervisor waits for it, too", arm, 8, 1, set_state(State::SafeOperational), "14 2", Origin::supervisor(),
     open_mode, State::PreOperational, 2, false},
    {"up to Safe-Operational with it", arm, 8, 1, set_state(State::SafeOperational), "ok, 60 W", Origin::ground(),
     open_mode, State::PreOperational, 2, true},
    {"down to Safe-Operational needs no link", arm, 8, 1, set_state(State::SafeOperational), "essential",
     Origin::ground(), open_mode, State::Operational, 2, false},
    {"to Operational after the link went", arm, 8, 1, set_state(State::Operational), "14 2", Origin::ground(),
     open_mode, State::SafeOperational, 2, false},
    {"to Operational", arm, 8, 1, set_state(State::Operational), "ok, lifts stop", Origin::ground(), open_mode,
     State::SafeOperational, 2, true},
    {"to Operational from elsewhere lifts nothing", arm, 8, 1, set_state(State::Operational), "ok", Origin::ground(),
     open_mode, State::PreOperational},
    // --- power: budget, reserved by others and requested, in mW ---------------------------------------------------
    {"what the budget does not carry", arm, 8, 1, set_state(State::SafeOperational), "16 0 0 234 95 0 0 0 0 0 0 234 96",
     Origin::ground(), open_mode, State::PreOperational, 2, true, 59.999},
    {"the supervisor's own start list, too", arm, 8, 1, set_state(State::SafeOperational),
     "16 0 0 234 95 0 0 0 0 0 0 234 96", Origin::supervisor(), open_mode, State::PreOperational, 2, true, 59.999},
    {"whoever stops acting is not asked for power", arm, 8, 1, set_state(State::SafeOperational), "essential",
     Origin::ground(), open_mode, State::Operational, 2, true, 1},
    {"without a configuration there is nothing to draw", arm, 8, 1, set_state(State::SafeOperational), "ok",
     Origin::ground(), open_mode, State::PreOperational, 0, true, 1},
    {"the handshake is the supervisor's", arm, 128, 1, {}, "ok", Origin::supervisor()},
    {"the handshake is not ground's", arm, 128, 1, {}, "13 1", Origin::ground()},
    {"the handshake is no subsystem's", arm, 128, 3, {}, "13 1", Origin::subsystem(hand)},
};

TEST(Permission, IsDecidedAsTheTableSays) {
  auto mission = testing::small_mission();
  mission.subsystems[2].subsystem.commands = {
      {.subsystem = "HAND", .functions = {"MOVE_TO"}, .at = {}, .apid = hand},
      {.subsystem = "ARM", .functions = {"MOVE_TO", "BRAKE"}, .at = {}, .apid = arm}};
  for (const Case& c : cases) {
    LinkGraph links{mission};
    links.set_up(2, c.link_up);
    const auto packet = testing::telecommand(c.apid, c.service, c.subtype, c.data);
    const auto view = pus::TelecommandView::parse(packet);
    const PowerLedger power{c.budget_w};
    const Situation situation{mission, mission.modes[c.mode], links, c.state, c.configuration, &power};
    EXPECT_EQ(text_of(decide(view.value(), c.origin, situation)), c.outcome) << c.says;
  }
}

TEST(Permission, TheGroundLinkComesUpWhateverTheBudgetAndItsPowerIsReserved) {
  auto mission = testing::small_mission();
  mission.ground.subsystem = "ARM";
  LinkGraph links{mission};
  links.set_up(2, true);
  const auto packet = testing::telecommand(arm, 8, 1, set_state(State::SafeOperational));
  const auto view = pus::TelecommandView::parse(packet);
  for (const double budget_w : {0.0, 0.001, 59.999, 60.0}) {
    const PowerLedger power{budget_w};
    for (const Origin& origin : {Origin::ground(), Origin::supervisor()})
      EXPECT_EQ(text_of(decide(view.value(), origin,
                               {mission, mission.modes[open_mode], links, State::PreOperational, 2, &power})),
                "ok, 60 W")
          << budget_w;
  }
}

TEST(Permission, WhoIsDownIsStartedByTheGroundWhereTheModeOpensThatAndByNobodyElse) {
  auto mission = testing::small_mission();
  mission.subsystems[2].subsystem.commands = {{.subsystem = "ARM", .functions = {"SET_STATE"}, .at = {}, .apid = arm}};
  const LinkGraph links{mission};
  const auto decided = [&](const std::vector<std::byte>& data, const Origin& origin, std::size_t mode, bool down) {
    const auto packet = testing::telecommand(arm, 8, 1, data);
    const Situation situation{.mission = mission,
                              .mode = mission.modes[mode],
                              .links = links,
                              .state = std::nullopt,
                              .configuration = 0,
                              .power = nullptr,
                              .down = down};
    return decide(pus::TelecommandView::parse(packet).value(), origin, situation);
  };
  const auto offline = set_state(State::Offline);
  const auto started = decided(offline, Origin::ground(), open_mode, true);
  ASSERT_TRUE(started);
  EXPECT_TRUE(started->starts);
  EXPECT_FALSE(started->essential);
  const auto in_narrow = decided(offline, Origin::ground(), narrow_mode, true);
  ASSERT_FALSE(in_narrow);
  EXPECT_EQ(in_narrow.error().code(), pus::FailureCode::WrongMode);
  const auto refused = [&](const auto& decision) {
    return !decision && decision.error().code() == pus::FailureCode::UnknownApid;
  };
  for (const Origin& origin : {Origin::supervisor(), Origin::subsystem(camera)})
    EXPECT_TRUE(refused(decided(offline, origin, open_mode, true)));
  for (const auto& other : {set_state(State::PreOperational), call("MOVE_TO")}) {
    const auto decision = decided(other, Origin::ground(), open_mode, true);
    EXPECT_TRUE(refused(decision));
    const auto reason = pus::reason_in(decision.error().data());
    ASSERT_TRUE(reason) << "the refusal says what helps";
    EXPECT_EQ(reason->text, "it is down; SET_STATE Offline starts it again");
  }
  const auto unreadable = decided(offline, Origin::ground(), open_mode, false);
  EXPECT_TRUE(refused(unreadable) && !pus::reason_in(unreadable.error().data())) << "it runs, its state cannot be read";
}

TEST(Permission, EverySubtypeOfEveryServiceIsKnownOrNot) {
  const auto mission = testing::small_mission();
  const LinkGraph links{mission};
  // What the services say of themselves; docs/services.md has it in words.
  const auto answers = [](int service, int subtype) {
    const auto* const kind = pus::standard_service(static_cast<std::uint8_t>(service));
    const auto id = static_cast<std::uint8_t>(subtype);
    return kind != nullptr && kind->request(id) != nullptr && kind->needs_of(id) != pus::Needs::SupervisorAnswers;
  };
  EXPECT_TRUE(answers(8, 1) && answers(128, 5) && !answers(8, 2) && !answers(129, 1) && !answers(99, 1));
  for (int service = 0; service < 256; ++service)
    for (int subtype = 0; subtype < 256; ++subtype) {
      const auto packet =
          testing::telecommand(arm, static_cast<std::uint8_t>(service), static_cast<std::uint8_t>(subtype), {});
      const auto decision = decide(pus::TelecommandView::parse(packet).value(), Origin::supervisor(),
                                   {mission, mission.modes[0], links, State::Operational, 0});
      EXPECT_EQ(decision.has_value(), answers(service, subtype)) << service << ',' << subtype;
    }
}

TEST(Permission, InEveryStateOfTheSupervisorAndFromEveryOriginSafeAllPassesAndNobodyElseChangesThatState) {
  const auto mission = testing::small_mission();
  const LinkGraph links{mission};
  for (int number = 0; number < 10; ++number)
    for (const Origin& origin : {Origin::ground(), Origin::subsystem(hand), Origin::supervisor()})
      for (const auto& mode : mission.modes) {
        const Situation situation{mission, mode, links, static_cast<State>(number), 0};
        const auto decided = [&](const std::vector<std::byte>& data) {
          const auto packet = testing::telecommand(1, 8, 1, data);
          return decide(pus::TelecommandView::parse(packet).value(), origin, situation);
        };
        const auto safe_all = decided(call("SAFE_ALL"));
        EXPECT_TRUE(safe_all && safe_all->essential) << number;
        for (int target = 0; target < 10; ++target) {
          const auto decision = decided(set_state(static_cast<State>(target)));
          EXPECT_EQ(decision.has_value(), origin.is_supervisor()) << number << " to " << target;
          if (!decision) {
            EXPECT_EQ(decision.error().code(), pus::FailureCode::WrongMode);
          }
        }
        EXPECT_EQ(decided(testing::call_data("CONFIGURE", 1)).has_value(), origin.is_supervisor());
      }
}

/// GAIN may be set in Safe-Operational where the mode opens it, LIMIT protects and never may.
TEST(Permission, AParameterIsWrittenOnlyInItsStatesAndOnlyWhereTheModeOpensIt) {
  auto mission = testing::small_mission();
  const auto parameter = [](const char* name, std::uint8_t id, std::uint16_t states) {
    descriptor::Parameter made;
    made.field.name = name;
    made.id = id;
    made.writable_states = states;
    return made;
  };
  mission.subsystems[0].subsystem.parameters = {parameter("GAIN", 3, testing::in_states({State::SafeOperational})),
                                                parameter("LIMIT", 5, 0)};
  // Structures of one number each, which is known by an id of its own.
  for (const auto& [name, member, states] : {std::tuple{"GAINS", 9, testing::in_states({State::SafeOperational})},
                                             std::tuple{"LIMITS", 10, std::uint16_t{0}},
                                             std::tuple{"OTHERS", 11, testing::in_states({State::SafeOperational})}}) {
    auto structure = parameter(name, static_cast<std::uint8_t>(member), states);
    structure.field.type = Type::Struct;
    structure.members.emplace_back().id = static_cast<std::uint8_t>(member);
    mission.subsystems[0].subsystem.parameters.push_back(structure);
  }
  mission.modes[open_mode].permits.front().parameters = {"GAIN", "GAINS", "LIMITS"};
  const LinkGraph links{mission};
  const auto write = [&](std::initializer_list<std::uint8_t> ids, State state, std::size_t mode, const Origin& origin) {
    std::vector<std::byte> data(1 + ids.size() * (4 + sizeof(double)));
    OctetWriter writer{data};
    writer.put(static_cast<std::uint8_t>(ids.size()));
    for (const std::uint8_t id : ids) {
      writer.put(ParameterId{arm, Type::Double, id}.wire());
      writer.put(1.0);
    }
    const auto packet = testing::telecommand(arm, 20, 3, data);
    const auto decision =
        decide(pus::TelecommandView::parse(packet).value(), origin, {mission, mission.modes[mode], links, state, 0});
    return decision ? 0 : static_cast<int>(decision.error().code());
  };
  constexpr int not_now = static_cast<int>(pus::FailureCode::NotPermittedNow);
  constexpr int wrong_mode = static_cast<int>(pus::FailureCode::WrongMode);
  const Origin ground = Origin::ground();
  EXPECT_EQ(write({3}, State::SafeOperational, open_mode, ground), 0);
  EXPECT_EQ(write({3}, State::Operational, open_mode, ground), not_now);
  EXPECT_EQ(write({5}, State::SafeOperational, open_mode, ground), not_now);
  EXPECT_EQ(write({3, 5}, State::SafeOperational, open_mode, ground), not_now);
  EXPECT_EQ(write({9, 3}, State::SafeOperational, open_mode, ground), 0) << "a member of GAINS";
  EXPECT_EQ(write({9}, State::Operational, open_mode, ground), not_now);
  EXPECT_EQ(write({9, 10}, State::SafeOperational, open_mode, ground), not_now) << "a member of what is never writable";
  EXPECT_EQ(write({9, 5}, State::SafeOperational, open_mode, ground), not_now) << "what stands behind a member is seen";
  EXPECT_EQ(write({11}, State::SafeOperational, open_mode, ground), wrong_mode);
  mission.modes[narrow_mode].permits.front().services = {20};
  EXPECT_EQ(write({3}, State::SafeOperational, narrow_mode, ground), wrong_mode);
  EXPECT_EQ(write({3}, State::SafeOperational, open_mode, Origin::subsystem(hand)),
            static_cast<int>(pus::FailureCode::NotDeclared));
  EXPECT_EQ(write({5}, State::Operational, open_mode, Origin::supervisor()), 0) << "begin values are its own";
}

TEST(Permission, ASubsystemMayStopTheCraftAndAsksTheSupervisorForNothingElse) {
  auto mission = testing::small_mission();
  mission.supervisor.functions.push_back(testing::function("SHUTDOWN", testing::in_states({State::Operational}), true));
  const LinkGraph links{mission};
  const auto permitted = [&](const char* name, const Origin& origin) {
    const auto packet = testing::telecommand(1, 8, 1, call(name));
    return decide(pus::TelecommandView::parse(packet).value(), origin,
                  {mission, mission.modes[open_mode], links, State::Operational, 0})
        .has_value();
  };
  for (const char* name : {"SET_MODE", "SHUTDOWN"}) {
    EXPECT_FALSE(permitted(name, Origin::subsystem(hand))) << name;
    EXPECT_TRUE(permitted(name, Origin::ground())) << name;
  }
  EXPECT_TRUE(permitted("SAFE_ALL", Origin::subsystem(hand)));
}

/// Two writes of eight octets, of which `octets` of application data arrive; the first names `id`.
TEST(Permission, AParameterWriteThatCannotBeReadToItsEndIsItsAddresseesToRefuse) {
  auto mission = testing::small_mission();
  descriptor::Parameter gain;
  gain.field.name = "GAIN";
  gain.id = 3;
  gain.writable_states = testing::in_states({State::Operational});
  mission.subsystems[0].subsystem.parameters = {gain};
  mission.modes[open_mode].permits.front().parameters = {"GAIN"};
  const LinkGraph links{mission};
  const auto refused = [&](std::uint8_t id, std::size_t octets) {
    std::vector<std::byte> data(1 + 2 * (4 + sizeof(double)));
    OctetWriter writer{data};
    writer.put(std::uint8_t{2});
    for (int i = 0; i < 2; ++i) writer.put(ParameterId{arm, Type::Double, id}.wire()).put(1.0);
    const auto packet = testing::telecommand(arm, 20, 3, Octets{data}.first(octets));
    return !decide(pus::TelecommandView::parse(packet).value(), Origin::ground(),
                   {mission, mission.modes[open_mode], links, State::Operational, 0});
  };
  EXPECT_FALSE(refused(3, 25));
  for (std::size_t octets = 0; octets < 25; ++octets) EXPECT_FALSE(refused(3, octets)) << octets;
  EXPECT_FALSE(refused(4, 25)) << "nobody knows how long an unknown one is";
}

TEST(Permission, APermitOfOneSubsystemOpensNoParameterOfAnother) {
  auto mission = testing::small_mission();
  descriptor::Parameter gain;
  gain.field.name = "GAIN";
  gain.id = 3;
  gain.writable_states = testing::in_states({State::Operational});
  mission.subsystems[0].subsystem.parameters = mission.subsystems[1].subsystem.parameters = {gain};
  mission.modes[narrow_mode].permits = {
      {.subsystem = "ARM", .functions = {}, .services = {}, .parameters = {"GAIN"}, .at = {}},
      {.subsystem = "*", .functions = {}, .services = {20}, .parameters = {}, .at = {}}};
  const LinkGraph links{mission};
  const auto permitted = [&](std::uint16_t apid, std::uint8_t subtype) {
    std::vector<std::byte> data(1 + 4 + sizeof(double));
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{apid, Type::Double, 3}.wire()).put(1.0);
    const auto packet = testing::telecommand(apid, 20, subtype, data);
    return decide(pus::TelecommandView::parse(packet).value(), Origin::ground(),
                  {mission, mission.modes[narrow_mode], links, State::Operational, 0})
        .has_value();
  };
  EXPECT_TRUE(permitted(arm, 3));
  EXPECT_FALSE(permitted(hand, 3));
  EXPECT_TRUE(permitted(hand, 1)) << "who reads changes nothing";
}

TEST(Permission, ALinkThatIsUsefulButNotRequiredIsNotWaitedFor) {
  auto mission = testing::small_mission();
  mission.subsystems[0].subsystem.configurations[0].requires_[0].required = false;
  const LinkGraph links{mission};
  const auto packet = testing::telecommand(arm, 8, 1, set_state(State::SafeOperational));
  const auto decision = decide(pus::TelecommandView::parse(packet).value(), Origin::ground(),
                               {mission, mission.modes[open_mode], links, State::PreOperational, 2});
  EXPECT_TRUE(decision);
}

TEST(Permission, ASetStateWithoutItsStateIsNotTowardsSafety) {
  const auto mission = testing::small_mission();
  const LinkGraph links{mission};
  const auto packet = testing::telecommand(arm, 8, 1, call("SET_STATE"));
  const auto decision = decide(pus::TelecommandView::parse(packet).value(), Origin::ground(),
                               {mission, mission.modes[open_mode], links, State::Operational, 0});
  ASSERT_TRUE(decision) << "its addressee says what is missing";
  EXPECT_FALSE(decision->essential);
}

TEST(Permission, ARequestOfASubsystemsOwnServiceIsPermittedByServiceOrNameInItsStates) {
  auto mission = testing::small_mission();
  descriptor::CustomService book;
  book.name = "BOOK";
  book.type = 200;
  book.requests = {testing::function("READ_PAGE", testing::in_states({State::SafeOperational})),
                   testing::function("CLOSE_BOOK", 0x3FF, true)};
  book.requests[0].service = book.requests[1].service = 200;
  book.requests[1].subtype = 3;
  mission.subsystems[0].subsystem.services = {book};
  const LinkGraph links{mission};
  const auto decided = [&](std::uint16_t apid, std::uint8_t subtype, State state) {
    const auto packet = testing::telecommand(apid, 200, subtype, {});
    return text_of(decide(pus::TelecommandView::parse(packet).value(), Origin::ground(),
                          {mission, mission.modes[narrow_mode], links, state, 0}));
  };
  EXPECT_EQ(decided(arm, 1, State::SafeOperational), "13 2") << "the mode opens neither service nor name";
  mission.modes[narrow_mode].permits = {
      {.subsystem = "ARM", .functions = {"READ_PAGE"}, .services = {}, .parameters = {}, .at = {}}};
  EXPECT_EQ(decided(arm, 1, State::SafeOperational), "ok");
  EXPECT_EQ(decided(arm, 1, State::Operational), "10 5");
  mission.modes[narrow_mode].permits = {
      {.subsystem = "ARM", .functions = {}, .services = {200}, .parameters = {}, .at = {}}};
  EXPECT_EQ(decided(arm, 1, State::SafeOperational), "ok");
  EXPECT_EQ(decided(arm, 3, State::Operational), "essential");
  EXPECT_EQ(decided(arm, 2, State::Operational), "7 200 2");
  EXPECT_EQ(decided(hand, 1, State::SafeOperational), "6 200") << "it is the arm's own";
}

TEST(Permission, TheHandshakeOfLinksStaysTheSupervisorsInAModeThatOpensItsService) {
  auto mission = testing::small_mission();
  mission.modes[open_mode].permits.front().services.push_back(128);
  const LinkGraph links{mission};
  const auto packet = testing::telecommand(arm, 128, 1, {});
  const auto permitted = [&](const Origin& origin) {
    return decide(pus::TelecommandView::parse(packet).value(), origin,
                  {mission, mission.modes[open_mode], links, State::PreOperational, 0})
        .has_value();
  };
  EXPECT_FALSE(permitted(Origin::ground()));
  EXPECT_FALSE(permitted(Origin::subsystem(hand)));
  EXPECT_TRUE(permitted(Origin::supervisor()));
}

TEST(Permission, APermitOfOneSubsystemOpensNoFunctionOfAnotherWhicheverComesFirst) {
  auto mission = testing::small_mission();
  const LinkGraph links{mission};
  for (const auto& [name, apid] : {std::pair{"ARM", arm}, std::pair{"HAND", hand}}) {
    mission.modes[narrow_mode].permits = {
        {.subsystem = name, .functions = {"MOVE_TO"}, .services = {}, .parameters = {}, .at = {}}};
    for (const std::uint16_t to : {arm, hand, camera}) {
      const auto packet = testing::telecommand(to, 8, 1, call("MOVE_TO"));
      const auto decision = decide(pus::TelecommandView::parse(packet).value(), Origin::ground(),
                                   {mission, mission.modes[narrow_mode], links, State::Operational, 0});
      EXPECT_EQ(decision.has_value(), to == apid) << name << " " << to;
      if (decision) {
        EXPECT_EQ(decision->reserves_w, 0) << "nobody goes up";
      }
    }
  }
}

}  // namespace
}  // namespace hirosco::supervisor
