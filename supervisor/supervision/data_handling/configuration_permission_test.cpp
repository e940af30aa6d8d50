// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>

#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// What the configuration in force changes of what is permitted: services that it leaves out, and configurations that may follow it
/// while the subsystem acts (docs/adr/0096).
namespace hirosco::supervisor {
namespace {

using descriptor::State;
using pus::FailureCode;
using testing::arm;
using testing::camera;

struct ConfigurationPermission : ::testing::Test {
  descriptor::Mission mission = [] {
    descriptor::Mission made = testing::small_mission();
    descriptor::SubsystemDescriptor& subsystem = made.subsystems[0].subsystem;
    const auto add = [&](std::string name, std::uint8_t id, Duration sampling, Duration budget, double power_w) {
      descriptor::Configuration configuration;
      configuration.name = std::move(name);
      configuration.id = id;
      configuration.sampling = sampling;
      configuration.budget = budget;
      configuration.priority = 30;
      configuration.power_w = power_w;
      subsystem.configurations.push_back(std::move(configuration));
    };
    add("CALM", 3, 4ms, 1ms, 20);
    add("QUICK", 4, 2ms, 1ms, 50);
    add("HOT", 5, 4ms, 1ms, 101);
    add("LONG", 6, 4ms, 3500us, 20);
    subsystem.bumpless.push_back({.configurations = {3, 4, 5, 6}, .steps = {}});
    subsystem.configurations[1].services.push_back({.type = 3, .offered = false});
    subsystem.service_uses.push_back({.type = 20, .offered = false});
    descriptor::Configuration watching;
    watching.name = "WATCHING";
    watching.id = 1;
    watching.sampling = 10ms;
    watching.budget = 2ms;
    watching.priority = 20;
    made.subsystems[2].subsystem.configurations = {watching};
    return made;
  }();
  LinkGraph links{mission};
  PowerLedger power{100.0};
  bool has_ledger{true}, knows_others{true};

  auto decide_on(std::uint8_t service, std::uint8_t subtype, Octets data, State state, std::uint8_t configuration) {
    const auto packet = testing::telecommand(arm, service, subtype, data);
    const descriptor::SubsystemDescriptor &one = mission.subsystems[0].subsystem,
                                          &other = mission.subsystems[2].subsystem;
    const std::function<std::vector<descriptor::InForce>()> in_force = [&] {
      return std::vector<descriptor::InForce>{{&one, one.find_configuration(configuration)},
                                              {&other, other.find_configuration("WATCHING")}};
    };
    Situation situation{.mission = mission,
                        .mode = mission.modes[0],
                        .links = links,
                        .state = state,
                        .configuration = configuration,
                        .power = has_ledger ? &power : nullptr};
    if (knows_others) situation.in_force = &in_force;
    return decide(*pus::TelecommandView::parse(packet), Origin::ground(), situation);
  }
  auto configure(std::uint8_t wanted, State state = State::Operational, std::uint8_t in_force = 3) {
    return decide_on(8, 1, testing::call_data("CONFIGURE", wanted), state, in_force);
  }
};

TEST_F(ConfigurationPermission, AServiceThatIsLeftOutIsUnknown) {
  const auto code = [&](std::uint8_t service, std::uint8_t subtype, std::uint8_t configuration) {
    const auto decision = decide_on(service, subtype, {}, State::Operational, configuration);
    return decision ? FailureCode{} : decision.error().code();
  };
  EXPECT_EQ(code(3, 5, 0), FailureCode{});
  EXPECT_EQ(code(3, 5, 4), FailureCode{});
  EXPECT_EQ(code(3, 5, 3), FailureCode::UnknownService);
  for (const int configuration : {0, 3, 4})
    EXPECT_EQ(code(20, 1, static_cast<std::uint8_t>(configuration)), FailureCode::UnknownService);
  EXPECT_EQ(code(17, 1, 3), FailureCode{});
}

TEST_F(ConfigurationPermission, ACompatibleConfigurationIsGrantedTheLargerPowerUntilItHasGoneOver) {
  for (const State state : {State::SafeOperational, State::Operational}) {
    EXPECT_EQ(configure(4, state).value().reserves_w, 50);
    EXPECT_EQ(configure(3, state, 4).value().reserves_w, 50) << "what it draws now";
  }
  EXPECT_EQ(configure(4, State::PreOperational).value().reserves_w, 0) << "it draws nothing before Safe-Operational";
  EXPECT_EQ(configure(2).value().reserves_w, 0) << "not compatible: its addressee refuses it";
}

TEST_F(ConfigurationPermission, WithoutPowerOrTimeForAllCyclesItIsRefused) {
  EXPECT_EQ(configure(5).error().code(), FailureCode::PowerShort);
  const auto takes_long = configure(6);
  ASSERT_FALSE(takes_long);
  EXPECT_EQ(takes_long.error().code(), FailureCode::NotPermittedNow);
  const auto why = pus::reason_in(takes_long.error().data());
  ASSERT_TRUE(why);
  EXPECT_EQ(why->text, "may not end in time then: CAMERA WATCHING");
  EXPECT_TRUE(configure(5, State::PreOperational)) << "power is asked for on the way up";
}

/// Who is brought down takes its loops of services back to what it says itself (docs/adr/0207).
TEST_F(ConfigurationPermission, WithoutTimeBesideLoopsOfWhoIsBroughtDownItIsRefused) {
  descriptor::SubsystemDescriptor& watches = mission.subsystems[2].subsystem;
  watches.service_loops.push_back({.name = "EYES", .period = 2ms, .priority = 40, .budget = 1ms});
  watches.configurations[0].paces.push_back({.name = "EYES", .period = 100ms, .priority = 10, .budget = 1ms});
  EXPECT_TRUE(configure(4)) << "as much time as there is";
  watches.service_loops[0].budget = 1001us;
  const auto takes_long = configure(4);
  ASSERT_FALSE(takes_long);
  EXPECT_EQ(takes_long.error().code(), FailureCode::NotPermittedNow);
  const auto why = pus::reason_in(takes_long.error().data());
  ASSERT_TRUE(why);
  EXPECT_EQ(why->text, "may not end in time then: " + mission.subsystems[0].subsystem.name + " QUICK");
  watches.service_loops.clear();
  EXPECT_TRUE(configure(4));
}

/// Its addressee says what is missing: it follows nothing, draws nothing more and keeps nobody waiting.
TEST_F(ConfigurationPermission, AConfigureWithoutItsConfigurationIsItsAddresseesToRefuse) {
  for (const State state : {State::SafeOperational, State::Operational}) {
    const auto decision = decide_on(8, 1, testing::call_data("CONFIGURE"), state, 3);
    ASSERT_TRUE(decision);
    EXPECT_EQ(decision->reserves_w, 0);
    EXPECT_FALSE(decision->essential);
  }
}

TEST_F(ConfigurationPermission, NoShortageRefusesAConfigurationOfGroundLinkOrPowerMeasurer) {
  ASSERT_EQ(configure(5).error().code(), FailureCode::PowerShort);
  mission.ground.subsystem = "ARM";
  EXPECT_EQ(configure(5).value().reserves_w, 101) << "it is counted all the same";
  mission.ground.subsystem.clear();
  ASSERT_FALSE(configure(5));
  mission.power_measured.emplace().apid = arm;
  EXPECT_EQ(configure(5).value().reserves_w, 101);
  mission.power_measured->apid = camera;
  EXPECT_EQ(configure(5).error().code(), FailureCode::PowerShort);
}

TEST_F(ConfigurationPermission, WherePowerOrTheCyclesOfOthersAreNoMatterTheyRefuseNothing) {
  has_ledger = false;
  EXPECT_EQ(configure(5).value().reserves_w, 0) << "nobody keeps account of it";
  EXPECT_FALSE(configure(6));
  knows_others = false;
  EXPECT_TRUE(configure(6));
  has_ledger = true;
  EXPECT_EQ(configure(6).value().reserves_w, 20);
  EXPECT_EQ(configure(5).error().code(), FailureCode::PowerShort);
}

}  // namespace
}  // namespace hirosco::supervisor
