// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "hirosco/subsystem/author/custom_service.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// What an author asks others for and tells by services of its own uses no heap once it is commissioned (adr 0103, 0220).
namespace hirosco {
namespace {

using testing::Rig;

constexpr const char* bard_descriptor = R"(<Subsystem name="BARD" id="11">
  <ParamRef name="TITLE" id="1" type="TEXT" octets="200" writable="Operational"/>
  <FunctionService>
    <Function name="SING">
      <Argument name="WORDS" type="TEXT" octets="200"/>
      <Argument name="PITCHES" type="DOUBLE" count="6" minimum="0" maximum="1"/>
    </Function>
  </FunctionService>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";
constexpr const char* patron_descriptor = R"(<Subsystem name="PATRON" id="10">
  <Commands subsystem="BARD" functions="SING" sets="TITLE"/>
  <CustomService name="SONGS" type="200">
    <Request name="WHICH" subtype="1"/>
    <Report name="THIS" subtype="2"><Field name="WORDS" type="TEXT" octets="200"/><Field name="PITCHES" type="DOUBLE" count="6"/></Report>
  </CustomService>
  <CustomService name="VERSES" type="201">
    <Request name="WHAT" subtype="1"/>
    <Report name="THAT" subtype="2"><Field name="WORDS" type="TEXT" octets="200"/></Report>
  </CustomService>
  <ServiceLoop name="HALL" period_us="10000" queue="4"/>
  <Service name="VERSES" loop="HALL"/>
  <Configuration name="ONE" id="1" sampling_us="1000"/>
</Subsystem>)";

/// Asks another with the longest arguments that there are, and tells as much by services of its own, one of them in a loop of its own.
struct Patron final : Subsystem {
  Request<std::string_view, std::array<double, 6>> sing{"BARD", "SING"};
  Request<std::string_view> entitle{"BARD", Ask::SetValue, "TITLE"};
  CustomService songs{"SONGS"}, verses{"VERSES"};
  std::string words{std::string(200, 'a')};
  std::array<double, 6> pitches{0, 0.2, 0.4, 0.6, 0.8, 1};
  std::array<std::uint64_t, 3> counts{};  ///< asked, ended, told
  bool asks{false}, careless{false};
  std::unique_ptr<std::string> kept;

  Result<> offline() override {
    songs.on_request("WHICH", [this](Call call) -> Result<> {
      ++counts[2];
      return songs.report("THIS", call, std::string_view{words}, pitches);
    });
    verses.on_request("WHAT", [this](Call call) -> Result<> {
      if (careless) kept = std::make_unique<std::string>(words);
      ++counts[2];
      return verses.report("THAT", call, std::string_view{words});
    });
    provide(songs);
    provide(verses);
    return ok();
  }
  Result<Step> software_init() override {
    const auto hear = [this](const RequestReport& report) {
      if (report.stage == RequestReport::Stage::Completed) ++counts[1];
    };
    use_request(sing, hear);
    use_request(entitle, hear);
    return done;
  }
  void service(TimePoint) override {
    if (!std::exchange(asks, false)) return;
    if (request(sing, words, pitches)) ++counts[0];
    if (request(entitle, words)) ++counts[0];
    EXPECT_FALSE(request(sing, words, {2, 2, 2, 2, 2, 2})) << "outside of their range";
  }
};

struct Patronage : ::testing::Test {
  Patron patron;
  Rig rig{patron, testing::read_descriptor(patron_descriptor, {bard_descriptor})};

  void SetUp() override { rig.bring_to(State::Operational, 1); }
  void fly(int steps) {
    for (int i = 0; i < steps; ++i) {
      patron.asks = i % 25 == 0;  // no more than a hundred go in a second
      if (i % 5 == 0) static_cast<void>(rig.send(i % 2 == 0 ? 200 : 201, 1, {}));
      rig.service();
      static_cast<void>(rig.own_loop(0, rig.clock.now()));
      for (const testing::Asked& asked : rig.asked) rig.verify(asked, 7);
      rig.asked.clear();
      rig.telemetry.clear();
      rig.cycle();
    }
    // Both loops have told what they did.
    rig.advance(std::chrono::seconds{1});
    rig.settle();
    rig.settle();
  }
  [[nodiscard]] std::uint64_t uses() const { return rig.subsystem.cycle().heap_uses().load().service; }
};

TEST_F(Patronage, UsesTheHeapForNoRequestOfAnAuthorAndNoReportOfItsServices) {
  fly(1'000);
  EXPECT_EQ(patron.counts, (std::array<std::uint64_t, 3>{80, 80, 200}));
  EXPECT_EQ(uses(), 0u);
  EXPECT_EQ(rig.heard(descriptor::framework_event::service_uses_heap), 0);
}

TEST_F(Patronage, OneInALoopOfItsOwnIsToldAndCountedAsTheServiceLoops) {
  patron.careless = true;
  fly(100);
  EXPECT_GE(uses(), 10u * 2);
  EXPECT_GE(rig.heard(descriptor::framework_event::service_uses_heap), 1);
}

}  // namespace
}  // namespace hirosco
