// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/measured_budget.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;
using Doubt = MeasuredBudget::Doubt;

constexpr std::uint16_t told_by = 4801;
/// A report of CAMERA: the structure's id, one octet of something, the budget.
constexpr std::size_t budget_at = 1, report_octets = 2 + 1 + 8;

[[nodiscard]] descriptor::MeasuredPower measured() {
  return {.name = "CAMERA.BUDGET",
          .age = 1s,
          .apid = camera,
          .at = {.structure = told_by, .offset = budget_at, .octets = report_octets}};
}
[[nodiscard]] std::vector<std::byte> report_data(double watts, std::uint16_t structure = told_by) {
  std::vector<std::byte> data(report_octets);
  OctetWriter writer{data};
  writer.put(structure).put(std::uint8_t{1}).put(watts);
  return data;
}

struct MeasuredBudgetTest : ::testing::Test {
  MeasuredBudget budget{measured()};
  TimePoint now{10s};
  bool hear(const std::vector<std::byte>& data, std::uint16_t from = camera, std::uint8_t subtype = 25) {
    std::array<std::byte, 256> buffer;
    const auto packet = pus::write_telemetry(buffer, {.apid = from, .service = 3, .subtype = subtype}, data);
    return budget.hear(from, pus::TelemetryView::parse(*packet).value(), now);
  }
};

TEST_F(MeasuredBudgetTest, IsWhatWasHeardLastAsLongAsThatIsYoungEnough) {
  EXPECT_EQ(budget.doubt(), Doubt::NeverHeard);
  EXPECT_TRUE(hear(report_data(472.5)));
  EXPECT_EQ(budget.watts(), 472.5);
  budget.watch(now + 1s);
  EXPECT_EQ(budget.watts(), 472.5);
  budget.watch(now + 1s + 1ns);
  EXPECT_EQ(budget.watts(), std::nullopt);
  EXPECT_EQ(budget.doubt(), Doubt::Old);
  EXPECT_TRUE(hear(report_data(0)));
  EXPECT_EQ(budget.watts(), 0) << "nothing is a measurement, too";
}

TEST_F(MeasuredBudgetTest, IsNoNumberThatCannotBe) {
  for (const double wrong :
       {-0.001, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(hear(report_data(500)));
    EXPECT_TRUE(hear(report_data(wrong)));
    EXPECT_EQ(budget.doubt(), Doubt::NoNumber) << wrong;
    EXPECT_EQ(budget.watts(), std::nullopt);
  }
  budget.watch(now + 2s);
  EXPECT_EQ(budget.doubt(), Doubt::Old);
}

TEST_F(MeasuredBudgetTest, IsNotHeardFromOthersNorInAnotherForm) {
  EXPECT_FALSE(hear(report_data(500), arm));
  EXPECT_FALSE(hear(report_data(500), camera, 26));
  EXPECT_FALSE(hear(report_data(500, told_by + 1)));
  auto longer = report_data(500);
  longer.push_back(std::byte{0});
  EXPECT_FALSE(hear(longer)) << "the ground appended something";
  EXPECT_FALSE(hear({std::byte{0x12}}));
  EXPECT_EQ(budget.doubt(), Doubt::NeverHeard);
}

TEST_F(MeasuredBudgetTest, OfWhoDoesNotRunIsNotKnownUntilItIsHeardAgain) {
  budget.gone();
  EXPECT_EQ(budget.doubt(), Doubt::NeverHeard);
  EXPECT_TRUE(hear(report_data(500)));
  budget.gone();
  EXPECT_EQ(budget.doubt(), Doubt::Gone);
  budget.watch(now + 10s);
  EXPECT_EQ(budget.doubt(), Doubt::Gone);
  EXPECT_TRUE(hear(report_data(500)));
  EXPECT_EQ(budget.watts(), 500);
}

/// ARM draws 60 W in its second configuration, HAND and CAMERA 20 W each; 40 W are granted whatever CAMERA measures.
struct MeasuredPowerTest : PartsTest {
  static descriptor::Mission made() {
    descriptor::Mission mission = parts_mission();
    mission.power_budget_w = 200;
    mission.power_measured = measured();
    mission.power_least_w = 40;
    return mission;
  }
  MeasuredPowerTest() : PartsTest{made()} {}
  void tell(double watts) { report(camera, 3, 25, report_data(watts)); }
  PowerLedger& ledger() { return parts.power.ledger(); }
};

TEST_F(MeasuredPowerTest, OnlyTheLeastIsGrantedUntilSomebodyMeasures) {
  start_all(PreOperational);
  parts.power.watch(clock.now());
  EXPECT_EQ(ledger().budget_mw(), 40'000U);
  EXPECT_EQ(ledger().basis(), "CAMERA.BUDGET was never heard");
  EXPECT_FALSE(craft.power_known());
  tell(100);
  EXPECT_TRUE(craft.power_known());
  EXPECT_EQ(ledger().budget_mw(), 100'000U);
  EXPECT_EQ(ledger().declared_mw(), 200'000U);
  tell(1000);
  EXPECT_EQ(ledger().budget_mw(), 200'000U) << "what the mission says is the most";
  tell(3);
  EXPECT_EQ(ledger().budget_mw(), 40'000U) << "never less than the least";
}

TEST_F(MeasuredPowerTest, AMeasurementThatFallsRefusesAndShedsNobody) {
  start_all(SafeOperational);
  set(arm, SafeOperational, 2);
  tell(200);
  parts.power.watch(clock.now());
  EXPECT_EQ(ledger().reserved_mw(), 100'000U);
  tell(50);
  parts.power.watch(clock.now());
  for (const std::uint16_t each : {arm, hand, camera}) {
    EXPECT_FALSE(craft.member(each)->recovery.going_down());
    EXPECT_FALSE(guard.fenced(each));
  }
  EXPECT_FALSE(ledger().overdrawn());
  const auto shortage = ledger().shortage(arm, 60);
  ASSERT_TRUE(shortage);
  EXPECT_EQ(shortage->budget, 50'000U);
  EXPECT_EQ(shortage->reserved, 40'000U);
}

TEST_F(MeasuredPowerTest, OneThatIsLostIsToldOnceAndGrantsTheLeastOnly) {
  start_all(PreOperational);
  tell(150);
  wait(1s);
  parts.power.watch(clock.now());
  EXPECT_EQ(ledger().budget_mw(), 150'000U);
  wait(1ms);
  parts.power.watch(clock.now());
  parts.power.watch(clock.now());
  EXPECT_EQ(ledger().budget_mw(), 40'000U);
  EXPECT_TRUE(was_told("CAMERA.BUDGET was not heard in its time: no more than 40 W are granted from now on"));
  EXPECT_EQ(std::ranges::count_if(story, [](const auto& line) { return line.find("no more than") != line.npos; }), 1);
  tell(150);
  EXPECT_TRUE(was_told("power budget 150 W: CAMERA.BUDGET measures it"));
  craft.member(camera)->died();
  parts.power.watch(clock.now());
  EXPECT_EQ(ledger().budget_mw(), 40'000U);
  EXPECT_EQ(ledger().basis(), "CAMERA.BUDGET is not measured: who measures it does not run");
}

TEST_F(MeasuredPowerTest, WhatATelecommandSaysIsTheMostToo) {
  start_all(PreOperational);
  tell(150);
  ledger().set_budget(30);
  EXPECT_EQ(ledger().budget_mw(), 30'000U);
}

}  // namespace
}  // namespace hirosco::supervisor
