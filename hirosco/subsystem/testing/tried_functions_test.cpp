// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/testing/tried_functions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "hirosco/subsystem/testing/probe.hpp"

namespace hirosco::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// The probe's SET_GOAL stores DES_POSITION, its MOVE nothing.
struct TriedFunctionsTest : ::testing::Test {
  Probe probe;

  static std::string where_sets_is(const std::string& function) {
    std::string text = probe_descriptor;
    const std::string parameter = R"(<ParamRef name="DES_POSITION" id="1" type="DOUBLE" />)";
    text.replace(text.find(parameter), parameter.size(),
                 R"(<ParamRef name="DES_POSITION" id="1" type="DOUBLE" protection="yes"/>)");
    const std::string named = "<Function name=\"" + function + "\"";
    return text.insert(text.find(named) + named.size(), " sets=\"DES_POSITION\"");
  }
  static TriedFunctions tried(Rig& rig) {
    return {rig,
            [&rig] {
              rig.set_state_now(State::SafeOperational);
              rig.set_state_now(State::Operational);
            },
            [&rig] { rig.settle(); }};
  }
};

TEST_F(TriedFunctionsTest, OfAFunctionThatSaysWhatItSetsThereIsNothingToTell) {
  Rig rig{probe, where_sets_is("SET_GOAL")};
  rig.bring_to(State::Operational);
  const auto functions = tried(rig);
  EXPECT_THAT(functions.untold(), IsEmpty());
  EXPECT_THAT(functions.idle(), IsEmpty());
}

TEST_F(TriedFunctionsTest, WhoSetsAProtectionAndDoesNotSaySoIsToldAndSoIsWhoSaysSoAndDoesNot) {
  Rig rig{probe, where_sets_is("MOVE")};
  rig.bring_to(State::Operational);
  const auto functions = tried(rig);
  EXPECT_THAT(functions.untold(), ElementsAre("SET_GOAL DES_POSITION"));
  EXPECT_THAT(functions.idle(), ElementsAre("MOVE DES_POSITION"));
}

}  // namespace
}  // namespace hirosco::testing
