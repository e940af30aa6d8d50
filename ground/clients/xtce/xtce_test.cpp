// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/xtce/xtce.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "ground/clients/xtce/testing.hpp"
#include "hirosco/xml/reader.hpp"

// That a foreign schema, decoder and ground station take the document is shown in tests/export.
namespace hirosco::ground {
namespace {

using testing::mission_with;

xml::Element read(const std::string& text) {
  auto tree = xml::read_tree(text);
  EXPECT_TRUE(tree) << (tree ? "" : tree.error().reason);
  return tree ? std::move(*tree) : xml::Element{};
}

std::string attribute(const xml::Element& element, const char* name) {
  const auto* found = element.find(name);
  return found == nullptr ? "" : found->value;
}

/// All elements of this tag whose attribute `name` is that one; any: of the tag.
void collect(const xml::Element& element, const std::string& tag, const std::string& name,
             std::vector<const xml::Element*>& found) {
  if (element.name == tag && (name.empty() || attribute(element, "name") == name)) found.push_back(&element);
  for (const auto& child : element.children) collect(child, tag, name, found);
}
std::vector<const xml::Element*> all(const xml::Element& element, const std::string& tag,
                                     const std::string& name = {}) {
  std::vector<const xml::Element*> found;
  collect(element, tag, name, found);
  return found;
}
const xml::Element& only(const xml::Element& element, const std::string& tag, const std::string& name = {}) {
  static const xml::Element none;
  const auto found = all(element, tag, name);
  EXPECT_EQ(found.size(), 1U) << tag << " " << name;
  return found.empty() ? none : *found.front();
}

xml::Element document_of(descriptor::Mission mission) { return read(xtce(Catalogue{std::move(mission)}).text); }

TEST(XtceNames, HaveNoCharacterThatAPathMeansSomethingBy) {
  XtceNames names;
  EXPECT_EQ(names.unique("MOVE_TO"), "MOVE_TO");
  EXPECT_EQ(names.unique("a.b/c:d[e] f"), "a_b_c_d_e__f");
  EXPECT_EQ(names.unique("a.b/c:d[e]_f"), "a_b_c_d_e__f_2");
  EXPECT_EQ(names.unique(""), "n");
}

TEST(Xtce, IsTheSameForTheSameDescriptors) {
  EXPECT_EQ(xtce(Catalogue{mission_with("ARM")}).text, xtce(Catalogue{mission_with("ARM")}).text);
}

TEST(Xtce, SaysAHousekeepingStructureByApplicationProcessIdAndLength) {
  const auto document = document_of(mission_with("ARM"));
  const auto& container = only(document, "SequenceContainer", "HK_99");
  const auto conditions = all(container, "Comparison");
  ASSERT_EQ(conditions.size(), 3U);
  EXPECT_EQ(attribute(*conditions[0], "value"), "10");
  EXPECT_EQ(attribute(*conditions[1], "value"), "99");
  // Behind the primary header, less one: 14 + (id 2, three of 2, 8 + 1, four of 8) + CRC 2 - 1.
  EXPECT_EQ(attribute(*conditions[2], "value"), "64");
  EXPECT_EQ(only(only(container, "RepeatEntry"), "FixedValue").text, "4");
}

/// A structure of two alike; a report has the second of them.
descriptor::Mission with_structures_within() {
  auto mission = mission_with("ARM");
  auto& subsystem = mission.subsystems.front().subsystem;
  auto& pose = subsystem.parameters[1];
  pose.members = {{testing::field_of("AXES[1].X", Type::Double), 20},
                  {testing::field_of("AXES[1].ON", Type::Bool), 21},
                  {testing::field_of("AXES[2].X", Type::Double), 22},
                  {testing::field_of("AXES[2].ON", Type::Bool), 23}};
  pose.parts = {{"AXES[1]", 9, 0, 2, {}}, {"AXES[2]", 10, 2, 2, {}}};
  auto& report = subsystem.housekeeping.front();
  report.sampled_once = {{"POSE.AXES[2]", 1, 5, {}}};
  report.sampled_repeatedly.clear();
  return mission;
}

TEST(Xtce, AReportOfAStructureWithinHasItsMembersAndNoOthers) {
  const auto document = document_of(with_structures_within());
  std::vector<std::string> entries;
  for (const auto* entry : all(only(document, "SequenceContainer", "HK_99"), "ParameterRefEntry"))
    entries.push_back(attribute(*entry, "parameterRef"));
  ASSERT_EQ(entries.size(), 3U) << "and the CRC";
  EXPECT_TRUE(entries[0].ends_with("/POSE/AXES_2__X")) << entries[0];
  EXPECT_TRUE(entries[1].ends_with("/POSE/AXES_2__ON")) << entries[1];
  // 14 + (id 2, 8 + 1) + CRC 2 - 1.
  EXPECT_EQ(attribute(*all(only(document, "SequenceContainer", "HK_99"), "Comparison")[2], "value"), "26");
}

TEST(Xtce, AStructureWithinIsReadByItsOwnIdAsAWhole) {
  const auto document = document_of(with_structures_within());
  EXPECT_EQ(all(document, "Parameter", "AXES_2_").size(), 1U);
  const std::string type = attribute(only(document, "Parameter", "AXES_2_"), "parameterTypeRef");
  const auto& aggregate = only(document, "AggregateParameterType", type.substr(type.rfind('/') + 1));
  EXPECT_EQ(all(aggregate, "Member").size(), 2U);
}

TEST(Xtce, SaysUnitRangeAndNamesOfValues) {
  const auto document = document_of(mission_with("ARM"));
  const auto& type = only(document, "FloatParameterType");
  EXPECT_EQ(only(type, "Unit").text, "m");
  EXPECT_EQ(attribute(only(type, "CriticalRange"), "minInclusive"), "-2");
  EXPECT_EQ(attribute(only(type, "CriticalRange"), "maxInclusive"), "1.5");
  EXPECT_EQ(attribute(only(only(document, "FloatArgumentType"), "ValidRange"), "maxInclusive"), "1.5");
  EXPECT_EQ(all(document, "ArrayParameterType").size(), 1U);
}

TEST(Xtce, AFunctionHasItsNameInSixteenOctetsAndEachArgumentItsId) {
  const auto document = document_of(mission_with("ARM"));
  const auto& command = only(document, "MetaCommand", "ARM");
  const auto fixed = all(command, "FixedValueEntry");
  ASSERT_EQ(fixed.size(), 3U);
  EXPECT_EQ(attribute(*fixed[0], "binaryValue"), "41524D00000000000000000000000000");
  EXPECT_EQ(attribute(*fixed[1], "binaryValue"), "01");
  EXPECT_EQ(attribute(*fixed[2], "binaryValue"), "01");
}

TEST(Xtce, WhatMayBeSetHasACommandOfItsOwnAndNothingElse) {
  const auto document = document_of(mission_with("ARM"));
  const auto& command = only(document, "MetaCommand", "WRITE_ARM");
  // ParameterId: subsystem 10, UINT16, id 7.
  EXPECT_EQ(attribute(*all(command, "FixedValueEntry")[1], "binaryValue"), "000A0307");
  EXPECT_TRUE(all(document, "MetaCommand", "WRITE_POSE_X").empty());
}

/// Names that an argument of a command may be given; none: it is a number.
std::vector<std::string> choices(const xml::Element& document, const xml::Element& command, const char* argument) {
  std::vector<std::string> names;
  const std::string type = attribute(only(command, "Argument", argument), "argumentTypeRef");
  for (const auto* each : all(document, "EnumeratedArgumentType"))
    if (type.ends_with(attribute(*each, "name")))
      for (const auto* value : all(*each, "Enumeration")) names.push_back(attribute(*value, "label"));
  return names;
}

TEST(Xtce, WhomAQuestionIsAboutIsChosenByNameAndItsEventByNumber) {
  auto mission = mission_with("ARM");
  mission.supervisor.events.push_back({"OTHER", 77, descriptor::Severity::Low, {}, {}});
  const auto document = document_of(mission);
  const auto& question = only(document, "MetaCommand", "PREVIEW_PLAN");
  EXPECT_EQ(choices(document, question, "SUBSYSTEM"), (std::vector<std::string>{"SUPERVISOR", "ARM"}));
  EXPECT_TRUE(choices(document, question, "EVENT").empty());
}

TEST(Xtce, EveryCommandEndsByCompletionOrByItsWindow) {
  const auto document = document_of(mission_with("ARM"));
  for (const auto* command : all(document, "MetaCommand")) {
    if (attribute(*command, "abstract") == "true") continue;
    const auto& complete = only(*command, "CompleteVerifier");
    EXPECT_EQ(only(complete, "AncillaryData").text, "FAIL");
  }
}

TEST(Xtce, OneEventIdHasOneNameWhoeverReportsIt) {
  auto mission = mission_with("ARM");
  mission.supervisor.events.push_back({"OTHER", 77, descriptor::Severity::Low, {}, {}});
  mission.supervisor.events.push_back({"ARM", 78, descriptor::Severity::Low, {}, {}});
  const auto names = event_names(Catalogue{std::move(mission)});
  EXPECT_EQ(names.at(77), "OTHER or ARM");
  EXPECT_EQ(names.at(78), "ARM");
}

TEST(Xtce, NoNameEndsWhereItStands) {
  for (const std::string& name : testing::hostile_names()) {
    const auto document = document_of(mission_with(name));
    // Parameters, containers and systems are as many as ever.
    EXPECT_EQ(all(document, "SequenceContainer", "HK_99").size(), 1U) << name;
    for (const char* tag : {"Parameter", "SpaceSystem", "SequenceContainer", "MetaCommand"})
      for (const auto* element : all(document, tag))
        EXPECT_EQ(attribute(*element, "name").find_first_of("./:[] "), std::string::npos) << name;
  }
}

TEST(Xtce, EveryReferenceLeadsToWhatThereIs) {
  const auto document = document_of(mission_with("ARM"));
  std::vector<std::string> paths;
  const auto walk = [&](const auto& self, const xml::Element& system, const std::string& parent) -> void {
    const std::string path = parent + "/" + attribute(system, "name");
    for (const auto& child : system.children) {
      if (child.name == "SpaceSystem") self(self, child, path);
      else if (child.name != "Header")
        for (const auto& set : child.children)
          for (const auto& named : set.children) paths.push_back(path + "/" + attribute(named, "name"));
    }
  };
  walk(walk, document, "");
  std::size_t references = 0;
  const auto check = [&](const auto& self, const xml::Element& element) -> void {
    for (const auto& one : element.attributes)
      if (one.name.ends_with("Ref") && one.value.starts_with("/") && !one.value.starts_with("/yamcs/")) {
        ++references;
        EXPECT_TRUE(std::ranges::find(paths, one.value) != paths.end()) << one.value;
      }
    for (const auto& child : element.children) self(self, child);
  };
  check(check, document);
  EXPECT_GT(references, 200U);
}

}  // namespace
}  // namespace hirosco::ground
