// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>

#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

/// The cycle takes a configuration over while the service loop is just giving all of it back.
namespace hirosco {
namespace {

using testing::Rig;
using testing::Sent;

constexpr const char* hasty_descriptor = R"(<Subsystem name="HASTY" id="10">
  <CustomService name="HERE" type="201"><Request name="LOOK" subtype="1"/></CustomService>
  <Configuration name="SOFT" id="1" sampling_us="1000"/>
  <Configuration name="STIFF" id="2" sampling_us="500"/>
  <Bumpless between="SOFT STIFF"/>
</Subsystem>)";

/// The test does in a step of its service loop what the other thread would.
struct Hasty final : Subsystem {
  CustomService here{"HERE"};
  std::function<void()> meanwhile;
  int taken_over{0};

  Result<> offline() override {
    here.on_request("LOOK", [this]() -> Result<> {
      meanwhile();
      return ok();
    });
    provide(here);
    return ok();
  }
  Result<> bumpless(const descriptor::Configuration&, const descriptor::Configuration&,
                    const Cycle&) noexcept override {
    ++taken_over;
    return ok();
  }
};

TEST(LateBumplessChange, ThatTheCycleTookOverAsItWasToRestIsToldBeforeItsConfigurationIsGivenBack) {
  Hasty author;
  Rig rig{author, hasty_descriptor};
  rig.bring_to(State::SafeOperational);
  const Sent change = rig.configure(2), down = rig.set_state(State::PostOperational);
  rig.service();
  author.meanwhile = [&] {
    // Its thread had looked whether it is wanted before it was to rest: it goes through one more cycle.
    static_cast<void>(rig.subsystem.cycle_step(rig.clock.now()));
    rig.subsystem.cycle_parked(rig.subsystem.cycle_demand().ticket);
  };
  static_cast<void>(rig.send(201, 1, {}));
  rig.service();
  EXPECT_EQ(author.taken_over, 1);
  EXPECT_EQ(rig.vital.configuration.load(), 0u) << "it is given back";
  rig.service();
  EXPECT_EQ(rig.outcome(change), "1 3 7") << "it was in force for that cycle";
  EXPECT_EQ(rig.outcome(down), "1 3 7");
  EXPECT_EQ(rig.state(), State::PostOperational);
  EXPECT_EQ(rig.vital.configuration.load(), 0u);
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.configure_now(1), "1 3 7");
}

}  // namespace
}  // namespace hirosco
