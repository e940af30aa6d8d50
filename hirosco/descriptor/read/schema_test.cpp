// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {

const std::filesystem::path folder = std::filesystem::path{HIROSCO_SOURCE_DIR} / "hirosco/descriptor";

bool run(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

bool validates(const std::string& schema, const std::filesystem::path& file) {
  return run("xmllint --noout --nonet --schema '" + (folder / schema).string() + "' '" + file.string() + "'");
}

TEST(Schema, AcceptsTheExamples) {
  ASSERT_TRUE(run("xmllint --version")) << "libxml2-utils is not installed";
  for (const char* name : {"hello.xml", "coronagraph.xml", "flywheel.xml", "supervisor.xml", "groundstation.xml"})
    EXPECT_TRUE(validates("subsystem.xsd", testing::data / name)) << name;
  EXPECT_TRUE(validates("mission.xsd", testing::data / "mission.xml"));
}

TEST(Schema, AcceptsWhatTheRepositoryShips) {
  ASSERT_TRUE(run("xmllint --version")) << "libxml2-utils is not installed";
  for (const char* part : {"missions", "subsystems", "supervisor"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator{folder / "../.." / part})
      if (entry.path().extension() == ".xml" && entry.path().parent_path().filename() != "tests") {
        const bool mission = entry.path().filename() == "mission.xml";
        EXPECT_TRUE(validates(mission ? "mission.xsd" : "subsystem.xsd", entry.path())) << entry.path();
      }
}

TEST(Schema, RefusesWhatTheReaderRefuses) {
  ASSERT_TRUE(run("xmllint --version")) << "libxml2-utils is not installed";
  const auto file = std::filesystem::path{HIROSCO_BINARY_DIR} / "schema_test.xml";
  for (const char* body :
       {"<ParamRef name=\"X\" id=\"1\" type=\"DUBLE\"/>", "<Paramters/>", "<TestService x=\"1\"/>",
        "<TestService self_test_within_ms=\"0\"/>",
        "<Configuration name=\"C\" id=\"1\" sampling_us=\"100\" self_test=\"yes\"/>",
        "<ParamRef name=\"X\" id=\"256\" type=\"DOUBLE\"/>", "<Resources memory_kB=\"0\"/>",
        "<ParamRef name=\"X\" id=\"1\" type=\"DOUBLE\" persistent=\"maybe\"/>",
        "<ParamRef name=\"X\" id=\"1\" type=\"DOUBLE\" read_only=\"yes\"/>",
        "<FunctionService><Function name=\"X\" id=\"1\"/></FunctionService>",
        "<ParamRef name=\"X\" id=\"1\" type=\"DOUBLE\"/><RealTimeLinkService><Provides name=\"P\" "
        "methods=\"tipc\"><ParamRef name=\"X\"/></Provides></RealTimeLinkService>",
        "<Device name=\"D\" actuator=\"yes\"><Output><Field name=\"F\" type=\"INT8\" safe=\"0\"/></Output>"
        "<Enable transfer=\"ethercat\" address=\"x\"/></Device>",
        "<Device name=\"D\"><Input><Field name=\"F\" type=\"INT8\" enumeration=\"E\"/></Input></Device>"}) {
    const std::string text = std::string{"<Subsystem name=\"S\" id=\"10\">"} + body + "</Subsystem>";
    std::ofstream{file} << text;
    EXPECT_FALSE(validates("subsystem.xsd", file)) << body;
    EXPECT_FALSE(testing::read_text(text).value) << body;
  }
  std::filesystem::remove(file);
}

TEST(Schema, TakesWhatAMissionChangesOfADeviceWithSeveralEndnodes) {
  ASSERT_TRUE(run("xmllint --version")) << "libxml2-utils is not installed";
  EXPECT_TRUE(validates("mission.xsd", folder / "../../tests/endnodes/two_pointing.xml"));
}

/// With the parts that it includes.
std::string text_of(const std::string& schema) {
  std::ifstream stream{folder / schema};
  std::string text{std::istreambuf_iterator<char>{stream}, {}};
  const std::regex part{"<xs:include schemaLocation=\"([^\"]+)\"/>"};
  const std::string own = text;
  for (std::sregex_iterator it{own.begin(), own.end(), part}, end; it != end; ++it) text += text_of((*it)[1]);
  return text;
}

/// The words of each enumeration that a schema has.
std::set<std::set<std::string>> enumerations_of(const char* schema) {
  const std::string text = text_of(schema);
  const std::regex word{"<xs:enumeration value=\"([^\"]+)\"/>"};
  std::set<std::set<std::string>> found;
  for (std::size_t at = text.find("<xs:restriction"); at != std::string::npos;
       at = text.find("<xs:restriction", at + 1)) {
    const std::string restriction = text.substr(at, text.find("</xs:restriction>", at) - at);
    std::set<std::string> words;
    for (std::sregex_iterator it{restriction.begin(), restriction.end(), word}, end; it != end; ++it)
      words.insert((*it)[1]);
    if (!words.empty()) found.insert(words);
  }
  return found;
}

template <class E>
std::set<std::string> words_of() {
  std::set<std::string> words;
  for (const auto& row : EnumTexts<E>::table) words.insert(std::string{row.text});
  return words;
}

/// Of these words those with which the reader takes `text`, where `@` stands for the word.
std::set<std::string> taken_of(const std::set<std::string>& words, const std::string& text) {
  std::set<std::string> taken;
  for (const std::string& word : words) {
    std::string said = text;
    if (testing::read_text(said.replace(said.find('@'), 1, word)).value) taken.insert(word);
  }
  return taken;
}

/// A word that the reader takes and no schema has is one that no editor offers and no table of consumers knows, and the other way round.
TEST(Schema, HasTheWordsOfEachEnumerationThatTheReaderTakesAndNoOthers) {
  const auto subsystem = enumerations_of("subsystem.xsd"), mission = enumerations_of("mission.xsd");
  ASSERT_GT(subsystem.size(), 8U);
  EXPECT_TRUE(subsystem.contains(words_of<State>()));
  EXPECT_TRUE(subsystem.contains(words_of<MissingPolicy>()));
  EXPECT_TRUE(subsystem.contains(words_of<SelfTest>()));
  EXPECT_TRUE(subsystem.contains(words_of<StopKind>()));
  EXPECT_TRUE(subsystem.contains(words_of<LinkKind>()));
  EXPECT_TRUE(subsystem.contains(words_of<Framing>()));
  EXPECT_TRUE(mission.contains(words_of<OnLoss>()));
  for (const auto* schema : {&subsystem, &mission}) EXPECT_TRUE(schema->contains(words_of<Severity>()));
  // What a plan may do; that each of them is a kind of step which the supervisor has does not compile otherwise.
  std::set<std::string> actions;
  for (const StepWord& step : plan_steps) actions.emplace(step.name);
  EXPECT_TRUE(mission.contains(actions)) << ::testing::PrintToString(actions);
  auto orders = words_of<ByteOrder>();
  orders.insert("native");
  EXPECT_TRUE(subsystem.contains(orders));
  auto numbers = words_of<Type>();  // BOOL and TEXT are of a type that adds them, a STRUCT of its own element
  for (const char* word : {"STRUCT", "BOOL", "TEXT"}) EXPECT_EQ(numbers.erase(word), 1U);
  EXPECT_TRUE(subsystem.contains(numbers));
  // Of these the reader knows more, to say that they are not built in.
  std::set<std::string> methods;
  for (const char* kind : {"latest", "queued"})  // what a method carries is its own
    methods.merge(taken_of(words_of<LinkMethod>(),
                           testing::changed("KIND", kind,
                                            R"(<Subsystem name="S" id="10"><ParamRef name="X" id="1" type="DOUBLE"/>
    <RealTimeLinkService><Provides name="P" methods="@" kind="KIND"><ParamRef name="X"/></Provides>
    </RealTimeLinkService></Subsystem>)")));
  EXPECT_GT(methods.size(), 1U);
  EXPECT_TRUE(subsystem.contains(methods));
  EXPECT_TRUE(mission.contains(methods));
  std::set<std::string> transfers;
  for (const char* address : {"127.0.0.1:5000", "plate", "/dev/ttyS0"})
    transfers.merge(taken_of(words_of<Transfer>(), std::string{R"(<Subsystem name="S" id="10"><Device name="D"><Input>
      <Field name="F" type="INT8"/></Input></Device><Configuration name="C" id="1" sampling_us="1000"><Device name="D">
      <Endnode transfer="@" address=")"} + address + R"("/></Device></Configuration></Subsystem>)"));
  EXPECT_GT(transfers.size(), 1U);
  EXPECT_TRUE(subsystem.contains(transfers)) << ::testing::PrintToString(transfers);
}

std::set<std::string> codes_in(const std::filesystem::path& file, const std::regex& form) {
  std::ifstream stream{file};
  const std::string text{std::istreambuf_iterator<char>{stream}, {}};
  std::set<std::string> codes;
  for (std::sregex_iterator it{text.begin(), text.end(), form}, end; it != end; ++it) codes.insert((*it)[1]);
  return codes;
}

TEST(ErrorCodes, AreListedInTheDocumentationAndOnlyThose) {
  std::set<std::string> emitted;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{folder}) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with("_test.cpp") || (!name.ends_with(".cpp") && !name.ends_with("reader.hpp"))) continue;
    emitted.merge(codes_in(entry.path(), std::regex{"\"(E[0-9]{4})\""}));
  }
  for (const char* const others :
       {"tools/hirosco", "supervisor/supervision/subsystem_handling", "hirosco/subsystem/service_loop"})
    for (const auto& entry : std::filesystem::directory_iterator{std::filesystem::path{HIROSCO_SOURCE_DIR} / others})
      if (!entry.path().filename().string().ends_with("_test.cpp"))
        emitted.merge(codes_in(entry.path(), std::regex{"\"(E[0-9]{4})\""}));
  const auto listed = codes_in(std::filesystem::path{HIROSCO_SOURCE_DIR} / "docs/descriptor-errors.md",
                               std::regex{"\\| (E[0-9]{4}) \\|"});
  EXPECT_GT(emitted.size(), 40U);
  EXPECT_EQ(emitted, listed);
}

}  // namespace
}  // namespace hirosco::descriptor
