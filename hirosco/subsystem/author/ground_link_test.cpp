// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/ground_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/inside.hpp"

/// Stops of everything and telecommands that lie in a ground link (docs/adr/0156, 0157).
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using testing::Rig;
using Said = GroundTraffic::Said;
using Taken = GroundTraffic::Taken;

/// What a transport was told, in order.
struct Told {
  GroundTraffic* traffic{nullptr};
  std::vector<std::string> words;
};
class Transport final : public GroundTransport {
 public:
  explicit Transport(Told& told) : told_{told} {}
  void all_stopped() override { told_.words.emplace_back("stopped"); }
  void step(TimePoint) override { told_.words.emplace_back("step"); }
  [[nodiscard]] std::size_t finish(TimePoint) override {
    told_.words.emplace_back("finish");
    return 3;
  }
  void telemetry(Octets) override { told_.words.emplace_back("telemetry"); }
  [[nodiscard]] const Counters& counters() const override { return counters_; }

 private:
  Told& told_;
  Counters counters_;
};

/// A ground link as short as its author may write one.
class Radio final : public Subsystem {
 public:
  explicit Radio(Told& told)
      : ground{*this,
               [&told](GroundTraffic& traffic) -> Result<std::unique_ptr<GroundTransport>> {
                 told.traffic = &traffic;
                 return std::make_unique<Transport>(told);
               },
               [this](Octets packet) { taken_octets += packet.size(); }} {}
  GroundLink ground;
  std::size_t taken_octets{0};

 private:
  Result<> configure(const descriptor::Configuration&) override { return ground.open(); }
  void service(TimePoint now) override { ground.step(now); }
  void telemetry(Octets packet) override { ground.telemetry(packet); }
};

struct AGroundLink : ::testing::Test {
  Told told;
  Radio author{told};
  Rig rig{author,
          R"(<Subsystem name="RADIO" id="20"><Configuration name="NOMINAL" id="1" sampling_us="10000"/></Subsystem>)"};
  std::array<std::byte, 64> buffer{};
  Octets ping{pus::write_telecommand(buffer, {.apid = 11, .service = 17, .subtype = 1}, {}).value()};

  void SetUp() override {
    rig.permit.newest_stop = 8;
    rig.bring_to(State::SafeOperational);
    rig.service();
    told.words.clear();
  }
  [[nodiscard]] std::vector<std::uint32_t> known_stops() const {
    std::vector<std::uint32_t> known;
    for (const testing::Asked& asked : rig.asked) known.push_back(asked.known_stop);
    return known;
  }
};

TEST_F(AGroundLink, TellsItsTransportOfAStopBeforeThatLooksForMore) {
  rig.service();
  EXPECT_THAT(told.words, ElementsAre("step"));
  rig.permit.newest_stop = 9;
  rig.service();
  EXPECT_THAT(told.words, ElementsAre("step", "stopped", "step"));
}

TEST_F(AGroundLink, TellsItsTransportOfAStopBeforeItHandsOverTheLast) {
  rig.permit.newest_stop = 9;
  EXPECT_EQ(author.ground.finish(rig.clock.now()), 3U);
  EXPECT_THAT(told.words, ElementsAre("stopped", "finish"));
}

TEST_F(AGroundLink, SaysWhatItKnewWhenItLookedAndNothingOfWhatWasPerhapsSaidBefore) {
  for (const Said said : {Said::Since, Said::PerhapsBefore})
    EXPECT_EQ(told.traffic->telecommand(3, ping, said), Taken::Yes);
  rig.permit.newest_stop = 9;  // it has not looked again
  EXPECT_EQ(told.traffic->telecommand(3, ping, Said::Since), Taken::Yes);
  rig.service();
  EXPECT_EQ(told.traffic->telecommand(3, ping, Said::Since), Taken::Yes);
  rig.service();
  EXPECT_THAT(known_stops(), ElementsAre(8U, 0U, 8U, 9U));
  EXPECT_EQ(author.taken_octets, 4 * ping.size());
}

TEST_F(AGroundLink, ThatIsClosedMovesNothing) {
  author.ground.close();
  rig.permit.newest_stop = 9;
  rig.service();
  author.ground.telemetry(ping);
  EXPECT_EQ(author.ground.finish(rig.clock.now()), 0U);
  EXPECT_FALSE(author.ground.is_open());
  EXPECT_TRUE(told.words.empty());
}

}  // namespace
}  // namespace hirosco
