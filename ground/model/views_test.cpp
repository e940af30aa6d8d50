// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/model/views.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

using testing::opening;

class AView : public ::testing::Test {
 protected:
  void takes(const std::vector<std::byte>& octets) {
    static_cast<void>(model.take(*pus::TelemetryView::parse(octets)));
  }
  [[nodiscard]] nlohmann::json status(OnboardTime now = opening) const { return status_json(catalogue, model, now); }
  [[nodiscard]] nlohmann::json drill() const { return status()["subsystems"][1]; }
  Catalogue catalogue{testing::workshop()};
  Model model{catalogue};
};

TEST_F(AView, OfAnEventHasItsSeverityInWordsAndItsValuesAsAnObject) {
  StoredEvent event{.t = opening,
                    .apid = 10,
                    .subsystem = "DRILL",
                    .id = 7,
                    .name = "TORQUE_HIGH",
                    .severity = 3,
                    .text = "<b>",
                    .values = R"({"JOINT":2})"};
  const nlohmann::json expected{
      {"t", 2'145'916'900},    {"apid", 10},           {"subsystem", "DRILL"}, {"id", 7},
      {"name", "TORQUE_HIGH"}, {"severity", "medium"}, {"text", "<b>"},        {"values", {{"JOINT", 2}}}};
  EXPECT_EQ(event_json(event), expected);
  for (const char* broken : {"", "[1]", "{"}) {
    event.values = broken;
    EXPECT_EQ(event_json(event)["values"], nlohmann::json::object()) << broken;
  }
}

TEST_F(AView, OfATelecommandHasACodeAndAReasonOnlyWhereThereAreSuch) {
  StoredCommand command;
  command.number = 3;
  command.function = "BORE";
  command.arguments = R"({"DEPTH":2.5})";
  command.stage = "sent";
  auto told = command_json(command);
  EXPECT_EQ(told["id"], 3);
  EXPECT_EQ(told["arguments"]["DEPTH"], 2.5);
  EXPECT_TRUE(told["code"].is_null());
  EXPECT_TRUE(told["reason"].is_null());
  command.code = 0;
  command.reason = "because";
  command.arguments = "DEPTH";
  told = command_json(command);
  EXPECT_EQ(told["code"], 0);
  EXPECT_EQ(told["reason"], "because");
  EXPECT_EQ(told["arguments"], nlohmann::json::object());
  EXPECT_EQ(report_json({opening, "failed", 13, "because"}),
            (nlohmann::json{{"t", 2'145'916'900}, {"stage", "failed"}, {"code", 13}, {"reason", "because"}}));
}

TEST_F(AView, OfAMarkHasNoEndWhereThereIsNoneAndOfAStackNotItsText) {
  StoredMark mark{.t = opening, .kind = "alarm", .name = "10/7", .action = "shelve", .who = "anna", .note = "later"};
  EXPECT_TRUE(mark_json(mark)["until"].is_null());
  EXPECT_EQ(mark_json(mark)["note"], "later");
  mark.until = opening + 60s;
  EXPECT_EQ(mark_json(mark)["until"], 2'145'916'960);
  mark.kind = "stack";
  EXPECT_EQ(mark_json(mark)["note"], "");
}

TEST_F(AView, OfWhatNobodyHasToldIsNull) {
  const auto told = status();
  EXPECT_TRUE(told["mode"].is_null());
  ASSERT_EQ(told["subsystems"].size(), 3U);
  for (const char* what : {"state", "configuration", "cycles", "memory_kb", "age_s"})
    EXPECT_TRUE(told["subsystems"][1][what].is_null()) << what;
  EXPECT_EQ(told["subsystems"][1]["inhibited"], nlohmann::json::array());
  EXPECT_TRUE(told["links"][0]["up"].is_null());
  EXPECT_TRUE(told["links"][0]["samples"].is_null());
  EXPECT_EQ(values_json(catalogue, model, 0), nlohmann::json::object());
}

TEST_F(AView, HasNamesForModeStateConfigurationAndReasonsOfInhibition) {
  takes(testing::overview(catalogue,
                          {.drill = 4,
                           .more = {{"SUPERVISOR.SUBSYSTEMS.INHIBITED[1]", 0b1000101},
                                    {"SUPERVISOR.SUBSYSTEMS.CYCLES[1]", 500},
                                    {"SUPERVISOR.SUBSYSTEMS.MEMORY[1]", 2048}}},
                          opening));
  EXPECT_EQ(status()["mode"], "work");
  EXPECT_EQ(drill()["state"], "SafeOperational");
  EXPECT_EQ(drill()["configuration"], "RUN");
  EXPECT_EQ(drill()["inhibited"], (nlohmann::json{"stop", "device", "awaited"}));
  EXPECT_EQ(drill()["cycles"], 500);
  EXPECT_EQ(drill()["memory_kb"], 2048);
  EXPECT_EQ(status(opening + 3s)["subsystems"][1]["age_s"], 3);
  EXPECT_EQ(status(opening + 3s)["t"], 2'145'916'903);
  takes(testing::overview(catalogue, {.drill = 255, .mode = 77}, opening + 1s));
  EXPECT_TRUE(drill()["state"].is_null()) << "it does not run";
  EXPECT_TRUE(status()["mode"].is_null()) << "the mission has no such mode";
}

TEST_F(AView, SaysWhatASubsystemWaitsForOnItsWayUp) {
  takes(testing::overview(catalogue, {.lamp = 3, .link_up = 0}, opening));
  EXPECT_EQ(status()["subsystems"][2]["waits_for"], "link 1 from DRILL.SPEED");
  takes(testing::overview(catalogue, {.lamp = 3}, opening + 1s));
  EXPECT_EQ(status()["subsystems"][2]["waits_for"], "");
  takes(
      testing::overview(catalogue, {.lamp = 3, .more = {{"SUPERVISOR.SUBSYSTEMS.CONFIGURATION[2]", 0}}}, opening + 2s));
  EXPECT_EQ(status()["subsystems"][2]["waits_for"], "a configuration");
}

TEST_F(AView, HasOfALinkWhatItsConsumerTellsWhileItIsUp) {
  const std::map<std::string, double> told{{"SUPERVISOR.LINK_STATUS.LOST[0]", 7},
                                           {"SUPERVISOR.LINK_STATUS.SAMPLES[0]", 100},
                                           {"SUPERVISOR.LINK_STATUS.AGE[0]", 30'000}};
  takes(testing::overview(catalogue, {.more = told}, opening));
  EXPECT_EQ(status()["links"][0]["up"], true);
  EXPECT_EQ(status()["links"][0]["lost"], 7);
  EXPECT_NEAR(status()["links"][0]["age_cycles"].get<double>(), 1.5, 1e-9) << "its consumer cycles every 20 ms";
  auto later = told;
  later["SUPERVISOR.LINK_STATUS.SAMPLES[0]"] = 150;
  takes(testing::overview(catalogue, {.more = later}, opening + 500ms));
  EXPECT_EQ(status()["links"][0]["rate_hz"], 100);
  takes(testing::overview(catalogue, {.link_up = 0, .more = later}, opening + 1s));
  EXPECT_EQ(status()["links"][0]["up"], false);
  EXPECT_TRUE(status()["links"][0]["lost"].is_null());
  EXPECT_TRUE(status()["links"][0]["rate_hz"].is_null());
}

TEST_F(AView, HasOnlyTheValuesThatAreNewerThanWhatSomebodyKnows) {
  takes(testing::housekeeping(catalogue, testing::drill_apid, 71, {{"DRILL.SPEED", 1.5}, {"DRILL.TOOL", 2}}, opening));
  const auto known = model.revision();
  EXPECT_EQ(values_json(catalogue, model, 0),
            (nlohmann::json{{"DRILL.SPEED", {1.5, 2'145'916'900}}, {"DRILL.TOOL", {2, 2'145'916'900}}}));
  takes(testing::housekeeping(catalogue, testing::drill_apid, 70, {{"DRILL.ON", 1}}, opening + 1s));
  const auto newer = values_json(catalogue, model, known);
  EXPECT_FALSE(newer.contains("DRILL.TOOL"));
  EXPECT_EQ(newer["DRILL.ON"], (nlohmann::json{true, 2'145'916'901}));
  EXPECT_EQ(newer["DRILL.LABEL"][0], "");
}

}  // namespace
}  // namespace hirosco::ground
