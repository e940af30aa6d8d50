// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/model/catalogue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

using testing::drill_apid;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class ACatalogue : public ::testing::Test {
 protected:
  [[nodiscard]] const Report& report(std::uint16_t sid) const {
    return *std::ranges::find(catalogue.reports(), sid, &Report::sid);
  }
  [[nodiscard]] const Place& place(std::uint16_t sid, const char* column) const {
    return *std::ranges::find(report(sid).places, catalogue.find_column(column).value(), &Place::column);
  }
  /// What the values of the first argument are called.
  [[nodiscard]] std::vector<std::string> texts(const char* subsystem, const char* function) const {
    const auto* who = catalogue.find(std::string_view{subsystem});
    const auto functions = catalogue.functions_of(*who);
    const auto found = std::ranges::find(functions, function, &descriptor::Function::name);
    if (found == functions.end()) return {"no such function"};
    std::vector<std::string> all;
    for (const auto& text : catalogue.texts_of(*who, *found, found->arguments.at(0)))
      all.push_back(std::to_string(text.value) + " " + text.text);
    return all;
  }
  Catalogue catalogue{testing::workshop()};
};

TEST_F(ACatalogue, HasTheSupervisorFirstAndFindsEachByNameAndNumber) {
  ASSERT_EQ(catalogue.subsystems().size(), 3U);
  EXPECT_EQ(catalogue.subsystems().front()->name, "SUPERVISOR");
  EXPECT_EQ(catalogue.find(drill_apid), catalogue.find(std::string_view{"DRILL"}));
  EXPECT_EQ(catalogue.find(std::string_view{"SAW"}), nullptr);
  EXPECT_EQ(catalogue.find(std::uint16_t{77}), nullptr);
  EXPECT_EQ(catalogue.name_of(drill_apid), "DRILL");
  EXPECT_EQ(catalogue.name_of(77), "APID 77");
}

TEST_F(ACatalogue, HasAColumnForEachElementWithUnitRangeAndNames) {
  const auto speed = catalogue.find_column("DRILL.SPEED");
  ASSERT_TRUE(speed);
  const Column& column = catalogue.columns()[*speed];
  EXPECT_EQ(column.apid, drill_apid);
  EXPECT_EQ(column.unit, "rad/s");
  EXPECT_EQ(column.minimum, 0.0);
  EXPECT_EQ(column.maximum, 100.0);
  EXPECT_EQ(column.enumeration, nullptr);
  EXPECT_TRUE(catalogue.find_column("DRILL.DEPTHS[1]"));
  EXPECT_FALSE(catalogue.find_column("DRILL.DEPTHS"));
  EXPECT_FALSE(catalogue.find_column("DRILL.DEPTHS[2]"));
  EXPECT_TRUE(catalogue.find_column("SUPERVISOR.SUBSYSTEMS.APID[3]"));
  const Column& tool = catalogue.columns()[catalogue.find_column("DRILL.TOOL").value()];
  ASSERT_NE(tool.enumeration, nullptr);
  EXPECT_EQ(tool.enumeration->texts.at(1).text, "Core");
  const Column& label = catalogue.columns()[catalogue.find_column("DRILL.LABEL").value()];
  EXPECT_EQ(label.text_octets, 8) << "words are one column";
}

TEST_F(ACatalogue, KnowsWhereEachValueStandsAndOfSeveralSamplesTheNewest) {
  EXPECT_EQ(report(70).octets, 2U + 8 + 1 + 8 + 2 * 2 * 4);
  EXPECT_EQ(report(70).configuration, 0) << "every one has it";
  EXPECT_EQ(report(70).period, 500ms);
  EXPECT_EQ(place(70, "DRILL.LABEL").offset, 2U);
  EXPECT_EQ(place(70, "DRILL.ON").offset, 10U);
  EXPECT_EQ(place(70, "DRILL.SPEED").offset, 11U);
  EXPECT_EQ(place(70, "DRILL.DEPTHS[0]").offset, 27U);
  EXPECT_EQ(place(70, "DRILL.DEPTHS[1]").offset, 31U);
  EXPECT_EQ(report(70).places.size(), 5U);
  EXPECT_EQ(report(71).configuration, 1);
  EXPECT_EQ(report(71).period, 100ms);
}

TEST_F(ACatalogue, RecognisesAReportByWhoSentItItsNumberAndItsLength) {
  std::vector<std::byte> data(11);
  OctetWriter{data}.put(std::uint16_t{71});
  EXPECT_EQ(catalogue.report_of(drill_apid, data), &report(71));
  EXPECT_EQ(catalogue.report_of(testing::lamp_apid, data), nullptr);
  EXPECT_EQ(catalogue.report_of(drill_apid, Octets{data}.first(10)), nullptr) << "another version of the descriptor";
  EXPECT_EQ(catalogue.report_of(drill_apid, Octets{data}.first(1)), nullptr);
  OctetWriter{data}.put(std::uint16_t{72});
  EXPECT_EQ(catalogue.report_of(drill_apid, data), nullptr);
}

TEST_F(ACatalogue, ReadsNumbersSwitchesAndWordsWhereTheyStand) {
  std::vector<std::byte> data(35);
  constexpr std::string_view words = "a\x07z";
  OctetWriter{data}.put(std::uint16_t{70}).put(std::as_bytes(std::span{words}));
  OctetWriter{std::span{data}.subspan(10)}.put(std::uint8_t{1}).put(2.5).put(1.0F).put(2.0F).put(3.0F).put(4.0F);
  EXPECT_EQ(catalogue.words(place(70, "DRILL.LABEL"), data), "a?z") << "none that steer a terminal";
  EXPECT_TRUE(std::isnan(catalogue.read(place(70, "DRILL.LABEL"), data)));
  EXPECT_EQ(catalogue.read(place(70, "DRILL.ON"), data), 1.0);
  EXPECT_EQ(catalogue.read(place(70, "DRILL.SPEED"), data), 2.5);
  EXPECT_EQ(catalogue.read(place(70, "DRILL.DEPTHS[0]"), data), 3.0);
  EXPECT_EQ(catalogue.read(place(70, "DRILL.DEPTHS[1]"), data), 4.0);
  EXPECT_EQ(catalogue.words(place(70, "DRILL.SPEED"), data), "");
}

TEST_F(ACatalogue, HasNamesForWhatAFunctionTakes) {
  EXPECT_EQ(texts("DRILL", "SET_STATE").at(5), "5 Operational");
  EXPECT_THAT(texts("DRILL", "CONFIGURE"), ElementsAre("1 RUN"));
  EXPECT_THAT(texts("SUPERVISOR", "SET_MODE"), ElementsAre("1 dark", "2 work"));
  EXPECT_THAT(texts("SUPERVISOR", "LINK"), ElementsAre("1 DRILL.SPEED to LAMP"));
  EXPECT_THAT(texts("DRILL", "BORE"), IsEmpty());
  EXPECT_THAT(texts("DRILL", "SET:GAIN"), IsEmpty());
}

TEST_F(ACatalogue, HasTheNamesOfAModeForNobodyButTheSupervisor) {
  auto mission = testing::workshop();
  auto& drill = mission.subsystems.front().subsystem;
  drill.functions.push_back(mission.supervisor.functions.front());
  const Catalogue other{mission};
  const auto* who = other.find(drill_apid);
  const auto& function = who->functions.back();
  ASSERT_EQ(function.name, "SET_MODE");
  EXPECT_THAT(other.texts_of(*who, function, function.arguments.at(0)), IsEmpty());
}

TEST_F(ACatalogue, KnowsTheRowsInWhichTheSupervisorTellsOfEverybody) {
  EXPECT_EQ(catalogue.supervisor_column("MODE"), catalogue.find_column("SUPERVISOR.MODE"));
  EXPECT_EQ(catalogue.supervisor_column("SUBSYSTEMS.APID"), catalogue.find_column("SUPERVISOR.SUBSYSTEMS.APID[0]"));
  EXPECT_EQ(catalogue.supervisor_column("LINK_QUALITY.JITTER"), std::nullopt);
  EXPECT_EQ(catalogue.supervisor_rows("MODE"), 1U);
  EXPECT_EQ(catalogue.supervisor_rows("SUBSYSTEMS.APID"), 4U);
  EXPECT_EQ(catalogue.supervisor_rows("LINK_QUALITY.JITTER"), 0U);
}

}  // namespace
}  // namespace hirosco::ground
