// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/read.hpp"

namespace hirosco::descriptor {
namespace {

constexpr const char* listing_1 = R"(<StructRef name="CUR_VALUES" id="0" type="STRUCT">
  <ParamRef name="STATE" id="0" type="INT32" />
  <ParamRef name="POSITION" id="0" type="DOUBLE" />
</StructRef>

<ParamRef name="DES_POSITION" id="1" type="DOUBLE" />
)";
constexpr const char* listing_2 = R"(<HKService id="4711" interval="500">
  <SampledOnce>
    <ParamRef name="CUR_VALUES" />
  </SampledOnce>
  <SampledNREPTimes nrep="5">
    <ParamRef name="DES_POSITION" />
  </SampledNREPTimes>
</HKService>
)";

FileSource text_source(std::string text) {
  return [text = std::move(text)](const std::filesystem::path&) -> std::optional<std::string> { return text; };
}

Reading<Subsystem> read_text(const std::string& text) { return read_subsystem("test.xml", text_source(text)); }

std::string rendered(const std::vector<Diagnostic>& problems, const std::string& text) {
  std::string all;
  for (const Diagnostic& problem : problems) all += problem.code + " " + render(problem, text_source(text), false);
  return all;
}

void expect_paper_model(const std::string& text, bool in_configuration) {
  const auto reading = read_text(text);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, text);
  const Subsystem& subsystem = *reading.value;
  ASSERT_EQ(subsystem.parameters.size(), 2U);
  const Parameter& values = subsystem.parameters[0];
  EXPECT_EQ(values.field.name, "CUR_VALUES");
  EXPECT_EQ(values.field.type, Type::Struct);
  ASSERT_EQ(values.members.size(), 2U);
  EXPECT_EQ(values.members[1].field.type, Type::Double);
  EXPECT_EQ(values.octets(), 12U);
  const auto& structures = in_configuration ? subsystem.configurations.at(0).housekeeping : subsystem.housekeeping;
  ASSERT_EQ(structures.size(), 1U);
  EXPECT_EQ(structures[0].id, 4711);
  EXPECT_EQ(structures[0].interval_cycles, 500U);
  EXPECT_TRUE(structures[0].enabled);
  ASSERT_EQ(structures[0].sampled_once.size(), 1U);
  EXPECT_EQ(fields_of(subsystem, structures[0].sampled_once[0]).size(), 2U);
  ASSERT_EQ(structures[0].sampled_repeatedly.size(), 1U);
  EXPECT_EQ(structures[0].sampled_repeatedly[0].repetitions, 5);
  EXPECT_EQ(structures[0].sampled_repeatedly[0].parameters.at(0).parameter, 1);
}

TEST(SubsystemDescriptor, AcceptsTheListingsOfThePaperDirectlyInsideIt) {
  expect_paper_model(std::string{"<Subsystem name=\"S\" id=\"10\">\n"} + listing_1 + listing_2 + "</Subsystem>", false);
}

TEST(SubsystemDescriptor, AcceptsTheListingsOfThePaperInParametersAndConfiguration) {
  expect_paper_model(std::string{"<Subsystem name=\"S\" id=\"10\"><Parameters>\n"} + listing_1 +
                         "</Parameters><Configuration name=\"C\" id=\"1\" sampling_us=\"500\">" + listing_2 +
                         "</Configuration></Subsystem>",
                     true);
}

}  // namespace
}  // namespace hirosco::descriptor
