// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/mission_json.hpp"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

class AMissionAsJson : public ::testing::Test {
 protected:
  [[nodiscard]] static nlohmann::json named(const nlohmann::json& list, const std::string& name) {
    for (const auto& one : list)
      if (one["name"] == name) return one;
    ADD_FAILURE() << "no " << name;
    return {};
  }
  [[nodiscard]] nlohmann::json drill() const { return told["subsystems"][1]; }
  const Catalogue catalogue{testing::workshop()};
  const std::array<Transition, 2> edges{{{descriptor::State::Offline, descriptor::State::SoftwareInit, false},
                                         {descriptor::State::Operational, descriptor::State::ErrorOperational, true}}};
  const FaultTexts faults{{"spindle", {{"unplug", "Unplug it"}}}, {"nobody's", {{"x", "y"}}}};
  const nlohmann::json told = mission_json(catalogue, edges, faults);
};

TEST_F(AMissionAsJson, HasEverybodyTheSupervisorFirst) {
  EXPECT_EQ(told["name"], "WORKSHOP");
  EXPECT_EQ(told["start_mode"], "work");
  ASSERT_EQ(told["subsystems"].size(), 3U);
  EXPECT_EQ(told["subsystems"][0]["name"], "SUPERVISOR");
  EXPECT_EQ(drill()["id"], testing::drill_apid);
  EXPECT_EQ(drill()["description"], "Bores holes");
  EXPECT_EQ(drill()["configurations"], nlohmann::json::array({{{"id", 1}, {"name", "RUN"}, {"sampling_hz", 100}}}));
  EXPECT_EQ(drill()["states"].size(), 10U);
}

TEST_F(AMissionAsJson, SaysHowOnboardTimeBecomesUnixTime) {
  EXPECT_EQ(told["epoch_unix_s"].get<std::int64_t>() + 2'145'916'837, 1'767'225'600)
      << "the beginning of 2026, leap seconds included";
}

TEST_F(AMissionAsJson, SaysOfEachFunctionWhatItTakes) {
  const auto bore = named(drill()["functions"], "BORE");
  EXPECT_EQ(bore["service"], 8);
  EXPECT_EQ(bore["subtype"], 1);
  EXPECT_EQ(bore["states"], nlohmann::json::array({"Operational"}));
  EXPECT_EQ(bore["essential"], false);
  EXPECT_EQ(bore["confirm"], false);
  const auto& depth = bore["arguments"][0];
  EXPECT_EQ(depth["type"], "DOUBLE");
  EXPECT_EQ(depth["count"], 1);
  EXPECT_EQ(depth["unit"], "mm");
  EXPECT_EQ(depth["min"], 1);
  EXPECT_EQ(depth["max"], 50);
  EXPECT_FALSE(depth.contains("default")) << "it has none";
  EXPECT_FALSE(depth.contains("enumeration"));
  const auto& tool = bore["arguments"][1];
  EXPECT_EQ(tool["default"], 1);
  EXPECT_FALSE(tool.contains("min"));
  EXPECT_EQ(tool["enumeration"], (nlohmann::json{{{"value", 1}, {"name", "Twist"}}, {{"value", 2}, {"name", "Core"}}}));
  EXPECT_EQ(named(drill()["functions"], "ENGRAVE")["arguments"][0]["octets"], 8);
  EXPECT_EQ(named(drill()["functions"], "WIPE")["confirm"], true);
  EXPECT_EQ(named(drill()["functions"], "PEEK")["service"], 200);
  EXPECT_EQ(named(drill()["functions"], "SET:GAIN")["service"], 20);
  EXPECT_EQ(named(drill()["functions"], "PING")["service"], 17);
  EXPECT_EQ(named(told["subsystems"][0]["functions"], "SAFE_ALL")["essential"], true);
}

TEST_F(AMissionAsJson, SaysWhatComesInHousekeepingAndAsEvents) {
  const nlohmann::json housekeeping = drill()["housekeeping"];
  ASSERT_EQ(housekeeping.size(), 2U);
  EXPECT_EQ(housekeeping[0]["sid"], 70);
  EXPECT_EQ(housekeeping[0]["period_s"], 0.5);
  EXPECT_EQ(housekeeping[0]["configuration"], 0);
  EXPECT_EQ(housekeeping[1]["configuration"], 1);
  const auto speed = named(housekeeping[0]["columns"], "DRILL.SPEED");
  EXPECT_EQ(speed["unit"], "rad/s");
  EXPECT_EQ(speed["min"], 0);
  EXPECT_EQ(speed["max"], 100);
  EXPECT_EQ(named(housekeeping[0]["columns"], "DRILL.LABEL")["octets"], 8);
  EXPECT_EQ(named(housekeeping[1]["columns"], "DRILL.TOOL")["enumeration"][1]["name"], "Core");
  const auto torque = named(drill()["events"], "TORQUE_HIGH");
  EXPECT_EQ(torque["id"], 7);
  EXPECT_EQ(torque["severity"], "medium");
  EXPECT_EQ(torque["arguments"][1]["unit"], "N m");
  EXPECT_EQ(named(drill()["events"], "SPINDLE_A_LOST")["severity"], "high");
}

TEST_F(AMissionAsJson, SaysWhoIsLinkedToWhomAndHowOldASampleMayBe) {
  ASSERT_EQ(told["links"].size(), 1U);
  const nlohmann::json expected{{"id", 1},        {"from", "DRILL"},       {"provides", "SPEED"},
                                {"to", "LAMP"},   {"requires", "SPEED"},   {"required", true},
                                {"rate_hz", 100}, {"age_limit_cycles", 3}, {"age_limit_cycles_reduced", 40}};
  EXPECT_EQ(told["links"][0], expected);
}

TEST_F(AMissionAsJson, SaysWhatAModePermitsAndBringsUp) {
  const auto dark = named(told["modes"], "dark"), work = named(told["modes"], "work");
  EXPECT_EQ(dark["permits"][0]["subsystem"], "*");
  EXPECT_EQ(dark["permits"][0]["functions"], (nlohmann::json{"SET_STATE", "CONFIGURE"}));
  EXPECT_EQ(dark["permits"][0]["services"], nlohmann::json::array({17}));
  EXPECT_EQ(work["commission"][1],
            (nlohmann::json{{"subsystem", "LAMP"}, {"configuration", "ON"}, {"state", "Operational"}}));
  EXPECT_EQ(work["establish"], nlohmann::json::array({1}));
}

TEST_F(AMissionAsJson, LeavesOutWhatAModePermitsToSubsystemsAlone) {
  auto guarded = testing::workshop();
  auto& permits = guarded.modes.at(0).permits;
  const std::size_t before = permits.size();
  permits.push_back(permits.front());
  permits.back().from = {"LAMP"};
  permits.push_back(permits.front());
  permits.back().from = {"LAMP", "ground"};
  const auto modes = mission_json(Catalogue{guarded}, edges, faults)["modes"];
  EXPECT_EQ(named(modes, guarded.modes.at(0).name)["permits"].size(), before + 1);
}

TEST_F(AMissionAsJson, HasTheFaultsOfItsDevicesAndTheEdgesOfTheStates) {
  EXPECT_EQ(told["simulated"], true);
  const nlohmann::json fault{{"line", "unplug"}, {"text", "Unplug it"}};
  const nlohmann::json spindle{
      {"name", "spindle"}, {"subsystem", "DRILL"}, {"device", "SPINDLE.A"}, {"faults", nlohmann::json::array({fault})}};
  EXPECT_EQ(told["devices"], nlohmann::json::array({spindle}));
  EXPECT_EQ(told["transitions"],
            (nlohmann::json{{{"from", "Offline"}, {"to", "SoftwareInit"}, {"kind", "commanded"}},
                            {{"from", "Operational"}, {"to", "ErrorOperational"}, {"kind", "failure"}}}));
  auto real = testing::workshop();
  real.devices.clear();
  EXPECT_EQ(mission_json(Catalogue{real}, edges, faults)["simulated"], false);
}

TEST_F(AMissionAsJson, WritesAWideNumberWithAllItsDigits) {
  auto wide = testing::workshop();
  auto& argument = wide.subsystems.front().subsystem.functions.at(2).arguments.front();
  argument.field.maximum = Number{std::uint64_t{18'446'744'073'709'551'615U}};
  const auto functions = mission_json(Catalogue{wide}, edges, faults)["subsystems"][1]["functions"];
  EXPECT_EQ(named(functions, "COUNT")["arguments"][0]["max"], "18446744073709551615") << "a page would round a number";
}

}  // namespace
}  // namespace hirosco::ground
