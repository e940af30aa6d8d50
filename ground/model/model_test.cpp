// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/model/model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "ground/model/views.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/crc32.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr int crowd = 20;

/// One camera and twenty lamps, each with a link from it.
descriptor::Mission mission_of_a_crowd() {
  std::string members = R"(<Subsystem executable="camera" descriptor="camera.xml"/>)", links;
  for (int i = 1; i <= crowd; ++i) {
    const std::string number = std::to_string(i);
    members += R"(<Subsystem executable="lamp" descriptor="lamp.xml" name="LAMP_)" + number + R"(" id=")" +
               std::to_string(100 + i) + R"("/>)";
    links += "<Link id=\"" + number + R"(" from="CAMERA.LIGHT" to="LAMP_)" + number + R"(.LIGHT"/>)";
  }
  const std::map<std::string, std::string> files{
      {"mission.xml", R"(<Mission name="CROWD"><Supervisor descriptor="supervisor.xml"/>)" + members + "<Links>" +
                          links + R"(</Links><Modes initial="dark" start="dark"><Mode name="dark">
<Permit subsystem="*" functions="SET_STATE CONFIGURE SET_MODE SHUTDOWN"/></Mode></Modes></Mission>)"},
      {"camera.xml",
       R"(<Subsystem name="CAMERA" id="10"><Parameters><ParamRef name="LEVEL" id="0" type="DOUBLE"/>
<ParamRef name="SHUTTERS" id="1" type="BOOL" count="2"/><ParamRef name="TITLE" id="2" type="TEXT" octets="6"/></Parameters>
<HKService id="7" interval="1"><SampledOnce><ParamRef name="SHUTTERS"/><ParamRef name="TITLE"/><ParamRef name="LEVEL"/>
</SampledOnce></HKService>
<Configuration name="ON" id="1" priority="80" sampling_us="10000"><RealTimeLinkService>
<Provides name="LIGHT" methods="shared_memory" byte_order="native" kind="latest"><ParamRef name="LEVEL"/></Provides>
</RealTimeLinkService></Configuration></Subsystem>)"},
      {"lamp.xml", R"(<Subsystem name="LAMP" id="11"><Configuration name="ON" id="1" priority="80" sampling_us="10000">
<RealTimeLinkService><Requires name="LIGHT" from="CAMERA" age="3" missing="inhibit" methods="shared_memory"
byte_order="native" kind="latest"><Field name="LEVEL" type="DOUBLE"/></Requires></RealTimeLinkService>
</Configuration></Subsystem>)"}};
  const descriptor::FileSource source = [&](const std::filesystem::path& file) -> Result<std::string> {
    const auto found = files.find(file.filename().string());
    if (found != files.end()) return found->second;
    return descriptor::file_system()(std::filesystem::path{HIROSCO_SOURCE_DIR} / "supervisor" / file.filename());
  };
  auto reading = descriptor::read_mission("mission.xml", source);
  for (const auto& problem : reading.problems) ADD_FAILURE() << descriptor::render(problem, source, false);
  return reading.value.value_or(descriptor::Mission{});
}

/// The supervisor's report of everybody, with values by the names of columns; all others are 0.
std::vector<std::byte> report_with(const Catalogue& catalogue, const std::map<std::string, std::uint32_t>& values,
                                   std::string_view of = "SUBSYSTEMS.APID") {
  const auto apid = catalogue.supervisor_column(of);
  for (const Report& report : catalogue.reports()) {
    if (std::ranges::find(report.places, apid.value_or(0), &Place::column) == report.places.end()) continue;
    std::vector<std::byte> data(report.octets);
    OctetWriter{data}.put(report.sid);
    for (const Place& place : report.places) {
      const Column& column = catalogue.columns()[place.column];
      const auto found = values.find(column.name.substr(column.name.find('.') + 1));
      if (found == values.end()) continue;
      OctetWriter writer{std::span{data}.subspan(place.offset)};
      if (column.type == Type::Uint8) writer.put(static_cast<std::uint8_t>(found->second));
      if (column.type == Type::Uint16) writer.put(static_cast<std::uint16_t>(found->second));
      if (column.type == Type::Uint32) writer.put(found->second);
    }
    return data;
  }
  ADD_FAILURE() << "nothing tells of everybody";
  return {};
}

TEST(AModel, KnowsEachOfMoreThanSixteenSubsystemsAndLinks) {
  const Catalogue catalogue{mission_of_a_crowd()};
  ASSERT_EQ(catalogue.subsystems().size(), crowd + 2U);
  std::map<std::string, std::uint32_t> told;
  for (std::size_t row = 0; row < catalogue.subsystems().size(); ++row) {
    const std::string index = "[" + std::to_string(row) + "]";
    told["SUBSYSTEMS.APID" + index] = catalogue.subsystems()[row]->id;
    told["SUBSYSTEMS.STATE" + index] = 5;
    told["SUBSYSTEMS.CYCLES" + index] = static_cast<std::uint32_t>(1000 + row);
  }
  for (std::uint32_t row = 0; row < crowd; ++row) {
    const std::string index = "[" + std::to_string(row) + "]";
    told["LINK_STATUS.LINK" + index] = row + 1;
    told["LINK_STATUS.IS_UP" + index] = 1;
    told["LINK_STATUS.SAMPLES" + index] = 500 + row;
    told["LINK_STATUS.LOST" + index] = row;
    told["LINK_QUALITY.JITTER" + index] = 70 + row;
    told["LINK_QUALITY.AGE_AT_USE" + index] = 90 + row;
    told["LINK_LATENCY.LINK" + index] = row + 1;
    told["LINK_LATENCY.PERIOD" + index] = row == 4 ? 0 : 500'000;
    told["LINK_LATENCY.IN_1_32" + index] = 100 + row;
    told["LINK_LATENCY.BEYOND" + index] = row;
  }
  told["LINK_STATUS.LOST[18]"] = 0xFFFF'FFFF;  // its consumer has no room to tell
  told["LINK_STATUS.SAMPLES[3]"] = told["LINK_STATUS.AGE[3]"] = 0xFFFF'FFFF;  // they pass nobody else
  const auto data = report_with(catalogue, told);
  std::array<std::byte, pus::max_telemetry_octets> buffer;
  constexpr OnboardTime t{std::chrono::seconds{2'145'916'900}};
  const auto packet = pus::write_telemetry(buffer, {.apid = 1, .service = 3, .subtype = 25, .time = t}, data);
  ASSERT_TRUE(packet);
  Model model{catalogue};
  std::array<std::byte, pus::max_telemetry_octets> quality_buffer;
  const auto quality = pus::write_telemetry(quality_buffer, {.apid = 1, .service = 3, .subtype = 25, .time = t},
                                            report_with(catalogue, told, "LINK_QUALITY.LINK"));
  ASSERT_TRUE(quality);
  static_cast<void>(model.take(*pus::TelemetryView::parse(*quality)));
  std::array<std::byte, pus::max_telemetry_octets> latency_buffer;
  const auto latency = pus::write_telemetry(latency_buffer, {.apid = 1, .service = 3, .subtype = 25, .time = t},
                                            report_with(catalogue, told, "LINK_LATENCY.LINK"));
  ASSERT_TRUE(latency);
  static_cast<void>(model.take(*pus::TelemetryView::parse(*latency)));
  static_cast<void>(model.take(*pus::TelemetryView::parse(*packet)));

  const json status = status_json(catalogue, model, t);
  ASSERT_EQ(status["subsystems"].size(), crowd + 2U);
  for (std::size_t row = 0; row < crowd + 2U; ++row) {
    EXPECT_EQ(status["subsystems"][row]["state"], "Operational") << row;
    EXPECT_EQ(status["subsystems"][row]["cycles"], 1000 + row);
  }
  ASSERT_EQ(status["links"].size(), crowd);
  for (std::size_t row = 0; row < crowd; ++row) {
    EXPECT_EQ(status["links"][row]["id"], row + 1);
    EXPECT_EQ(status["links"][row]["up"], true) << row;
    EXPECT_EQ(status["links"][row]["jitter_ns"], 70 + row);
    EXPECT_EQ(status["links"][row]["age_at_use_us"], 90 + row);
    if (row == 4) EXPECT_TRUE(status["links"][row]["latencies"].is_null()) << "nothing is counted";
    else
      EXPECT_EQ(status["links"][row]["latencies"],
                (json{{"period_ns", 500'000}, {"counts", {0, 100 + row, 0, 0, 0, 0, 0, 0, row}}}));
    if (row == 3) {
      EXPECT_TRUE(status["links"][row]["samples"].is_null());
      EXPECT_TRUE(status["links"][row]["age_cycles"].is_null());
    } else {
      EXPECT_EQ(status["links"][row]["samples"], 500 + row);
    }
    if (row == 18) EXPECT_TRUE(status["links"][row]["lost"].is_null());
    else EXPECT_EQ(status["links"][row]["lost"], row);
  }
}

TEST(AModel, SaysWhoFliesByAnotherTextThanItHasRead) {
  const Catalogue catalogue{mission_of_a_crowd()};
  Model model{catalogue};
  const auto taken = [&](std::uint32_t hash) {
    const auto event = catalogue.mission().supervisor.find_event("DESCRIPTOR_TAKEN");
    std::vector<std::byte> data(8);
    OctetWriter{data}.put(event->id).put(std::uint16_t{10}).put(hash);
    std::array<std::byte, pus::max_telemetry_octets> buffer;
    const auto packet = pus::write_telemetry(
        buffer, {.apid = 1, .service = 5, .subtype = 1, .time = OnboardTime{std::chrono::seconds{2'145'916'900}}},
        data);
    const Heard heard = model.take(*pus::TelemetryView::parse(*packet));
    return heard.event ? heard.event->text : std::string{};
  };
  const std::uint32_t read = crc32(std::as_bytes(std::span{*catalogue.find(10)->text}));
  EXPECT_EQ(taken(read).find("another text"), std::string::npos) << taken(read);
  EXPECT_NE(taken(read + 1).find("by another text than this station has read of CAMERA"), std::string::npos)
      << taken(read + 1);
}

TEST(AModel, TellsSwitchesAsTrueAndFalseAndTextsAsWords) {
  const Catalogue catalogue{mission_of_a_crowd()};
  std::vector<std::byte> data(2 + 2 + 6 + 8);
  OctetWriter writer{data};
  constexpr std::string_view words = "caf\xC3\xA9\0";
  writer.put(std::uint16_t{7}).put(std::uint8_t{0}).put(std::uint8_t{1});
  writer.put(std::as_bytes(std::span{words.data(), 6})).put(0.5);
  std::array<std::byte, pus::max_telemetry_octets> buffer;
  constexpr OnboardTime t{std::chrono::seconds{2'145'916'900}};
  const auto packet = pus::write_telemetry(buffer, {.apid = 10, .service = 3, .subtype = 25, .time = t}, data);
  ASSERT_TRUE(packet);
  Model model{catalogue};
  static_cast<void>(model.take(*pus::TelemetryView::parse(*packet)));
  const json values = values_json(catalogue, model, 0);
  EXPECT_EQ(values["CAMERA.SHUTTERS[0]"][0], json(false));
  EXPECT_EQ(values["CAMERA.SHUTTERS[1]"][0], json(true));
  EXPECT_EQ(values["CAMERA.TITLE"][0], json("caf\xC3\xA9"));
  EXPECT_EQ(values["CAMERA.LEVEL"][0], json(0.5)) << "what stands behind words is at its place";
}

}  // namespace
}  // namespace hirosco::ground
