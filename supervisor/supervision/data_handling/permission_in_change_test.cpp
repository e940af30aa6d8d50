// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

using descriptor::State;
using testing::arm;
using testing::call_data;

TEST(Permission, WhileTheModeChangesTheCraftIsLookedAtAndTakenTowardsSafetyNothingElse) {
  auto mission = testing::small_mission();
  descriptor::CustomService own;
  own.name = "PICTURES";
  own.type = 200;
  own.requests = {testing::function("TAKE", testing::in_states({State::Operational}))};
  own.requests.front().service = own.type;
  own.requests.front().subtype = 1;
  mission.subsystems.front().subsystem.services = {own};
  mission.modes.front().permits.front().services.push_back(own.type);
  const auto set_state = [](State state) { return call_data("SET_STATE", static_cast<int>(state)); };
  LinkGraph links{mission};
  links.set_up(2, true);
  const auto decided = [&](std::uint8_t service, std::uint8_t subtype, const std::vector<std::byte>& data, State state,
                           const Origin& origin = Origin::ground()) {
    const auto packet = testing::telecommand(arm, service, subtype, data);
    Situation situation{mission, mission.modes.front(), links, state, 2};
    situation.changing = true;
    return decide(pus::TelecommandView::parse(packet).value(), origin, situation);
  };
  const auto refused = [&](const auto& decision) {
    return !decision && decision.error().code() == pus::FailureCode::NotPermittedNow &&
           pus::reason_in(decision.error().data())->text == "a change of mode is under way, from mode";
  };
  for (const auto& moves : {call_data("MOVE_TO"), set_state(State::SafeOperational), set_state(State::Offline)})
    EXPECT_TRUE(refused(decided(8, 1, moves, State::SafeOperational)));
  EXPECT_TRUE(refused(decided(8, 1, call_data("MOVE_TO"), State::Operational)));
  EXPECT_TRUE(refused(decided(20, 3, {}, State::Operational))) << "a setting";
  EXPECT_TRUE(refused(decided(200, 1, {}, State::Operational))) << "a request of an author's own service";
  EXPECT_TRUE(refused(decided(17, 128, {}, State::SafeOperational))) << "a self test";
  EXPECT_TRUE(decided(8, 1, call_data("BRAKE"), State::Operational));
  EXPECT_TRUE(decided(8, 1, set_state(State::ErrorOperational), State::Operational));
  EXPECT_TRUE(decided(8, 1, set_state(State::SafeOperational), State::Operational));
  EXPECT_TRUE(decided(17, 1, {}, State::Operational));
  EXPECT_TRUE(decided(20, 1, {}, State::Operational));
  EXPECT_TRUE(decided(3, 5, {}, State::Operational));
  EXPECT_TRUE(decided(8, 1, set_state(State::Operational), State::SafeOperational, Origin::supervisor()))
      << "a step of the change";
}

/// Who acts is held back where it was said before a stop; towards safety nobody is, nor what the addressee refuses itself.
TEST(Permission, MoreThanALookIsWhatModeAndStateBindAndNothingElse) {
  const auto mission = testing::small_mission();
  const LinkGraph links{mission};
  const auto acts = [&](const char* function, const Origin& origin = Origin::ground()) {
    const auto packet = testing::telecommand(arm, 8, 1, call_data(function));
    return decide(pus::TelecommandView::parse(packet).value(), origin,
                  {mission, mission.modes.front(), links, State::Operational, 0})
        .value()
        .acts;
  };
  EXPECT_TRUE(acts("MOVE_TO"));
  EXPECT_FALSE(acts("BRAKE")) << "it is essential";
  EXPECT_FALSE(acts("DANCE")) << "its addressee does not know it";
  EXPECT_FALSE(acts("MOVE_TO", Origin::supervisor())) << "a step of its own is held back by nothing";
}

}  // namespace
}  // namespace hirosco::supervisor
