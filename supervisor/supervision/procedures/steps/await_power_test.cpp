// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/steps/await_power.hpp"

#include "supervisor/supervision/procedures/steps/step_kinds.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct AwaitPowerTest : PartsTest {
  std::vector<std::string> ends;
  bool known{false};

  void await(std::int64_t most_ms) {
    const ProcedureStep awaited = step("await_power", supervisor_apid, {most_ms});
    awaited.kind->run(awaited, means_with(parts.own_telecommands),
                      [this](bool success, const std::string& why) { ends.push_back(success ? "done" : why); });
  }
  void look_after(Duration span) {
    wait(span);
    parts.waiting.watch(clock.now());
  }
};

TEST_F(AwaitPowerTest, WhereNobodyMeasuresThereIsNothingToAwait) {
  craft.power_known = nullptr;
  await(1000);
  EXPECT_THAT(ends, ElementsAre("done"));
}

TEST_F(AwaitPowerTest, IsDoneAsSoonAsSomebodyHasMeasured) {
  craft.power_known = [this] { return known; };
  await(1000);
  look_after(999ms);
  EXPECT_THAT(ends, IsEmpty());
  known = true;
  look_after(0ms);
  EXPECT_THAT(ends, ElementsAre("done"));
}

TEST_F(AwaitPowerTest, GoesOnWithoutAMeasurementAtItsTimeAndNeverFails) {
  craft.power_known = [this] { return known; };
  await(1000);
  look_after(1000ms);
  EXPECT_THAT(ends, ElementsAre("done"));
  ends.clear();
  await(0);
  EXPECT_THAT(ends, ElementsAre("done")) << "where it is given no time";
}

}  // namespace
}  // namespace hirosco::supervisor
