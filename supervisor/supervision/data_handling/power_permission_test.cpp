// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// Who is granted electrical power, where it is measured and where it is not (docs/adr/0124).
namespace hirosco::supervisor {
namespace {

using descriptor::State;
using testing::arm;
using testing::hand;

/// ARM draws 60 W in its configuration 2, and has its link.
struct PowerPermission : ::testing::Test {
  descriptor::Mission mission = testing::small_mission();
  LinkGraph links{mission};
  PowerLedger power{100};
  PowerPermission() { links.set_up(2, true); }
  pus::FailureCode ask(State from, State to, std::uint16_t apid = arm, const Origin& origin = Origin::ground()) {
    const auto packet = testing::telecommand(apid, 8, 1, testing::call_data("SET_STATE", static_cast<int>(to)));
    const auto decision = decide(pus::TelecommandView::parse(packet).value(), origin,
                                 {mission, mission.modes[0], links, from, 2, &power});
    return decision ? pus::FailureCode{} : decision.error().code();
  }
};

TEST_F(PowerPermission, WhoeverIsToActNeedsThePowerToBeThereAndWhoeverStopsDoesNot) {
  for (const auto& [granted_w, outcome] :
       {std::pair{60.0, pus::FailureCode{}}, std::pair{59.999, pus::FailureCode::PowerShort}}) {
    power.set_grantable(granted_w, "dusk");
    EXPECT_EQ(ask(State::PreOperational, State::SafeOperational), outcome) << granted_w;
    EXPECT_EQ(ask(State::SafeOperational, State::Operational), outcome) << granted_w;
    EXPECT_EQ(ask(State::Operational, State::SafeOperational), pus::FailureCode{}) << granted_w;
    EXPECT_EQ(ask(State::SafeOperational, State::PostOperational), pus::FailureCode{}) << granted_w;
  }
}

TEST_F(PowerPermission, WhoMeasuresThePowerComesUpWhateverIsMeasured) {
  power.set_grantable(0, "eclipse");
  mission.power_measured = descriptor::MeasuredPower{.name = "HAND.BUDGET", .age = {}, .apid = hand, .at = {}};
  EXPECT_EQ(ask(State::PreOperational, State::SafeOperational), pus::FailureCode::PowerShort);
  mission.power_measured->apid = arm;
  EXPECT_EQ(ask(State::PreOperational, State::SafeOperational), pus::FailureCode{});
}

/// One that goes on for another may find a budget that does not even suffice for itself; a greater one is its to take.
TEST_F(PowerPermission, TheSupervisorComesUpWhateverTheBudgetIs) {
  descriptor::Configuration own;
  own.id = 2;
  own.power_w = 12;
  mission.supervisor.configurations = {own};
  power.set_budget(0.001);
  for (const auto& [from, to] : {std::pair{State::PreOperational, State::SafeOperational},
                                 std::pair{State::SafeOperational, State::Operational}}) {
    EXPECT_EQ(ask(from, to, pus::supervisor_apid, Origin::supervisor()), pus::FailureCode{});
    for (const Origin& other : {Origin::ground(), Origin::subsystem(hand)})
      EXPECT_EQ(ask(from, to, pus::supervisor_apid, other), pus::FailureCode::WrongMode) << "it is nobody else's";
    EXPECT_EQ(ask(from, to, arm, Origin::supervisor()), pus::FailureCode::PowerShort) << "of others it asks for power";
  }
}

}  // namespace
}  // namespace hirosco::supervisor
