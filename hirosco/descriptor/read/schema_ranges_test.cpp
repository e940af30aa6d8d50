// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "hirosco/descriptor/testing.hpp"
#include "hirosco/xml/reader.hpp"

/// The range of each number of the schemas is the reader's. What the schemas say is read in docs/interfaces/schema.md, which tools/check_schema.py
/// holds to them.
namespace hirosco::descriptor {
namespace {

/// A row of that page that has a range.
struct RangedAttribute {
  std::vector<std::string> ways;  ///< to its element: "Subsystem/Resources/Pool"
  std::string name, least, most;
};

std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells{""};
  for (std::size_t i = 1; i < row.size(); ++i) {
    if (row[i] == '|' && row[i - 1] != '\\') cells.emplace_back();
    else cells.back() += row[i];
  }
  return cells;  // attribute, what, unit, range, left out
}

std::vector<RangedAttribute> ranged_attributes() {
  std::ifstream page{std::filesystem::path{HIROSCO_SOURCE_DIR} / "docs/interfaces/schema.md"};
  const std::regex range{" (-?[0-9.]+) to (-?[0-9.]+) "}, way{"`([^`]+)`"};
  std::vector<RangedAttribute> found;
  std::vector<std::string> ways;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) ways = {line.substr(line.find(' ') + 1)};
    if (line.starts_with("Also `"))
      for (std::sregex_iterator it{line.begin(), line.end(), way}, end; it != end; ++it) ways.push_back((*it)[1]);
    if (!line.starts_with("| `")) continue;
    const auto cells = cells_of(line);
    if (std::smatch ends; cells.size() > 4 && std::regex_match(cells[3], ends, range))
      found.push_back({ways, cells[0].substr(2, cells[0].size() - 4), ends[1], ends[2]});
  }
  return found;
}

// Each element with a number that has a range, and each such attribute where it has a meaning: what else is wrong with these is no matter.
const std::string ranged_subsystem = R"(<Subsystem name="S" id="10">
  <ServiceLoop name="SLOW" period_us="20000" priority="1" budget_us="9" queue="3"/><Service name="ST03" loop="SLOW"/>
  <Resources memory_kB="900000"><Pool block="64" count="2"/></Resources>
  <Parameters>
    <StructRef name="SEEN" id="1" from="OTHER.SEEN" age_ms="100">
      <ParamRef name="A" id="1" type="DOUBLE" count="2"/><ParamRef name="B" id="2" type="TEXT" octets="8"/>
      <StructRef name="C" id="2" count="2"><ParamRef name="D" id="3" type="INT8"/></StructRef>
    </StructRef>
    <ParamRef name="E" id="4" type="DOUBLE" count="2"/><ParamRef name="F" id="5" type="TEXT" octets="8"/>
    <ParamRef name="G" id="6" type="DOUBLE" from="OTHER.G" age_ms="100"/>
  </Parameters>
  <Subscribes subsystem="OTHER" housekeeping="1"/>
  <EventService><Event name="H" id="9" severity="info">
    <Argument name="A" type="UINT8" count="2"/><Argument name="B" type="TEXT" octets="8"/></Event></EventService>
  <FunctionService><Function name="I"><Argument name="A" type="DOUBLE" count="2" minimum="0" maximum="1"/>
    <Argument name="B" type="TEXT" octets="8"/></Function></FunctionService>
  <TestService self_test_within_ms="100"/>
  <HKService id="9" interval="60"><SampledNREPTimes nrep="2"><ParamRef name="E"/></SampledNREPTimes></HKService>
  <RealTimeLinkService>
    <Provides name="J" kind="loaned"><Field name="A" type="UINT8" count="2"/></Provides>
    <Requires name="K" kind="queued" depth="8" age="3" age_reduced="9"><Field name="A" type="UINT8"/></Requires>
    <Requires name="L" kind="loaned"><Field name="A" type="UINT8" count="2"/></Requires>
  </RealTimeLinkService>
  <CustomService name="M" type="200">
    <Request name="N" subtype="1"><Argument name="A" type="DOUBLE" count="2" minimum="0" maximum="1"/>
      <Argument name="B" type="TEXT" octets="8"/></Request>
    <Report name="O" subtype="2"><Field name="A" type="DOUBLE" count="2"/><Field name="B" type="TEXT" octets="8"/></Report>
  </CustomService>
  <Hang realtime="20" reduced="200"/>
  <Device name="P" actuator="yes" stop="controlled" stop_within_ms="9"><Input><Field name="A" type="INT8" count="2"/></Input>
    <Output><Field name="A" type="INT8" count="1" safe="0"/></Output>
    <Enable transfer="unix" address="e" silence_ms="30" silence_reduced_ms="90"/>
    <Power transfer="unix" address="w" silence_ms="30" silence_reduced_ms="90"/></Device>
  <Device name="Q"><Endnode name="A" actuator="yes" stop="controlled" stop_within_ms="9">
    <Output><Field name="A" type="INT8" safe="0"/></Output></Endnode></Device>
  <Configuration name="R" id="1" priority="1" sampling_us="1000" budget_us="9" spin_us="9" overruns="3" power_W="5">
    <Device name="P" silence="3"><Endnode transfer="unix" address="p"/></Device>
    <Device name="Q"><Endnode name="A" silence="3" silence_reduced="9" watchdog_ms="50" watchdog_reduced_ms="60" every="1"
      transfer="unix" address="q"/></Device>
    <ServiceLoop name="SLOW" period_us="20000" priority="1" budget_us="9"/>
  </Configuration>
  <Configuration name="T" id="2" sampling_us="1000" started_by="K" least_us="100"/>
</Subsystem>)";

/// The good mission with whatever else has a number.
std::string ranged_mission() {
  const std::pair<const char*, const char*> more[]{
      {R"(path="log/orbiter.db")", R"(path="log/orbiter.db" rotate_MB="9" rotate_h="9" keep_MB="99")"},
      {R"(<Power budget_W="150"/>)", R"(<Power budget_W="150" measured="FLYWHEEL.NONE" age_ms="9" least_W="1">
        <Draw of="FLYWHEEL" measured="FLYWHEEL.NONE" age_ms="9" longer_than_ms="9" beyond_W="1"/></Power>
        <Resources/>)"},
      {R"(<Link id="2" )", R"(<Link id="2" on_loss="hold" hold_ms="9" )"},
      {R"(<Do action="log"/>)", R"(<Do action="log"/></Plan>
        <Plan name="back"><When event="PROCESS_DIED"/><Do action="restart" limit="3" within_s="9" pause_ms="9"/></Plan>
        <Plan name="all" priority="9"><When event="HANG"/><Do action="link" link="1"/><Do action="power" budget_W="9"/>
          <Do action="wait_for" of="FLYWHEEL" state="Offline" within_ms="9"/>
          <Do action="command" subsystem="FLYWHEEL" function="SET_FORCE_SCALE" arguments="0.1" done_within_s="99"/>)"}};
  std::string text = testing::good_mission();
  for (const auto& [from, to] : more) text = testing::changed(from, to, text);
  return text;
}

/// Elements that are reached by this way from the one at whose place it begins.
void collect(const xml::Element& element, std::string_view way, std::vector<const xml::Element*>& found) {
  const auto slash = way.find('/');
  if (element.name != way.substr(0, slash)) return;
  if (slash == way.npos) return found.push_back(&element);
  for (const xml::Element& child : element.children) collect(child, way.substr(slash + 1), found);
}

/// In a text of ASCII.
std::size_t offset_of(const std::string& text, xml::Position at) {
  std::size_t begin = 0;
  for (int line = 1; line < at.line; ++line) begin = text.find('\n', begin) + 1;
  return begin + static_cast<std::size_t>(at.column) - 1;
}

/// The text with this value of the attribute, marked; without a mark: no element of it has one.
std::string with_value(const std::string& text, const RangedAttribute& attribute, const std::string& value) {
  const auto root = xml::read_tree(text);
  if (!root) return text;
  std::vector<const xml::Element*> elements;
  for (const std::string& way : attribute.ways) collect(*root, way, elements);
  if (elements.empty()) return text;
  const auto says =
      std::ranges::find_if(elements, [&](const auto* each) { return each->find(attribute.name) != nullptr; });
  std::string changed = text;
  if (says != elements.end()) {
    const xml::Attribute& at = *(*says)->find(attribute.name);
    return changed.replace(offset_of(text, at.value_at), at.value.size(), "@" + value);
  }
  const xml::Element& first = *elements.front();
  return changed.insert(offset_of(text, first.at) + 1 + first.name.size(),
                        " " + attribute.name + "=\"@" + value + "\"");
}

/// What the reader says at the mark of a number: out of range, or none.
std::string refusal_at_mark(const std::string& marked_text, bool mission) {
  const testing::Marked file = testing::marked(marked_text);
  const auto problems =
      mission ? read_mission(testing::data / "mission.xml", testing::overlay({{"mission.xml", file.text}})).problems
              : testing::read_text(file.text).problems;
  for (const Diagnostic& each : problems)
    if (each.at == file.at && (each.code == "E0111" || each.code == "E0112") &&
        (!mission || each.file.filename() == "mission.xml"))
      return each.code + " " + each.message;
  return "";
}

/// The least number below a least end, and the like above.
std::string below(const std::string& least) {
  return least.find('.') != least.npos ? std::to_string(std::stod(least) / 2) : std::to_string(std::stoll(least) - 1);
}
std::string above(const std::string& most) { return std::to_string(std::stoull(most) + 1); }

TEST(SchemaRanges, AreTakenByTheReaderAtBothEndsAndRefusedBeyond) {
  const auto attributes = ranged_attributes();
  ASSERT_GT(attributes.size(), 90U) << "docs/interfaces/schema.md is read otherwise now";
  const std::string missions = ranged_mission();
  for (const RangedAttribute& attribute : attributes) {
    SCOPED_TRACE(attribute.ways.front() + "@" + attribute.name + ": " + attribute.least + " to " + attribute.most);
    const bool mission = attribute.ways.front().starts_with("Mission");
    const auto refusal = [&](const std::string& value) {
      const std::string text = with_value(mission ? missions : ranged_subsystem, attribute, value);
      EXPECT_NE(text.find('@'), text.npos) << "add its element to the document of this test";
      return refusal_at_mark(text, mission);
    };
    EXPECT_EQ(refusal(attribute.least), "");
    EXPECT_EQ(refusal(attribute.most), "");
    EXPECT_NE(refusal(below(attribute.least)), "") << below(attribute.least);
    EXPECT_NE(refusal(above(attribute.most)), "") << above(attribute.most);
  }
}

TEST(SchemaRanges, AReaderThatTakesLessOrMoreThanASchemaSaysIsSeen) {
  const RangedAttribute interval{{"Subsystem/HKService"}, "interval", "0", "4294967295"};
  EXPECT_EQ(refusal_at_mark(with_value(ranged_subsystem, interval, "0"), false).substr(0, 5), "E0112");
  EXPECT_EQ(refusal_at_mark(with_value(ranged_subsystem, interval, "1"), false), "");
}

}  // namespace
}  // namespace hirosco::descriptor
