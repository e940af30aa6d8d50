// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/injection_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::tools {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// "1500 ms robot unplug" of each, or why there is no plan.
std::vector<std::string> planned(const std::vector<std::string>& texts, Duration run_for = 3s) {
  const auto plan = plan_injections(texts, run_for);
  if (!plan) return {plan.error()};
  std::vector<std::string> all;
  for (const Injection& each : *plan)
    all.push_back(std::to_string(each.after / 1ms) + " ms " + each.device + " " + each.line);
  return all;
}

TEST(InjectionPlan, GoesByTheTimesAndNotByTheOrderOnTheCommandLine) {
  EXPECT_THAT(planned({"2.5 robot plug", "1.5 robot unplug", "0 stick hold 0.02 0 2"}),
              ElementsAre("0 ms stick hold 0.02 0 2", "1500 ms robot unplug", "2500 ms robot plug"));
}

TEST(InjectionPlan, KeepsTheOrderOfThoseOfOneTime) {
  EXPECT_THAT(planned({"2 robot unplug", "1 b old 1", "1 a old 2", "1.0 b new"}),
              ElementsAre("1000 ms b old 1", "1000 ms a old 2", "1000 ms b new", "2000 ms robot unplug"));
}

TEST(InjectionPlan, HasNoneThatWouldComeWhenTheFlightIsOver) {
  for (const char* late : {"5 robot unplug", "3 robot unplug", "1e300 robot unplug"})
    EXPECT_THAT(
        planned({"1 robot plug", late}),
        ElementsAre(HasSubstr(std::string{"--at '"} + late + "' would come when the flight is over: it takes 3 s")));
  EXPECT_THAT(planned({"2.999 robot unplug"}), ElementsAre("2999 ms robot unplug"));
}

TEST(InjectionPlan, NamesWhatIsNoInjection) {
  for (const char* wrong : {"", "5", "soon robot unplug", "-1 robot unplug", "robot unplug"})
    EXPECT_THAT(planned({wrong}),
                ElementsAre(HasSubstr(std::string{"--at '"} + wrong + "' is not \"SECONDS DEVICE LINE\"")));
}

}  // namespace
}  // namespace hirosco::tools
