// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {

using namespace testing;

TEST(Resources, AreWhatTheDescriptorSaysAndWhatItLeavesOutIsNotLimited) {
  const auto said = read_text(R"(<Subsystem name="ARM" id="10">
    <Resources memory_kB="65536" shared_memory_kB="2048" threads="4" descriptors="64" processor_percent="150" warning_percent="60" waiting_events="128" channel_kB="128">
      <Pool block="1000" count="8"/><Pool block="64" count="512"/>
    </Resources></Subsystem>)")
                        .value.value()
                        .resources;
  EXPECT_EQ(amount_of(said.most, Resource::Memory), 65'536U);
  EXPECT_EQ(amount_of(said.most, Resource::SharedMemory), 2048U);
  EXPECT_EQ(amount_of(said.most, Resource::Threads), 4U);
  EXPECT_EQ(amount_of(said.most, Resource::Descriptors), 64U);
  EXPECT_EQ(amount_of(said.most, Resource::Processor), 150U);
  EXPECT_EQ(said.warning_percent, 60U);
  ASSERT_EQ(said.pools.size(), 2U);
  EXPECT_EQ(said.pools[0].block_octets, 64U);
  EXPECT_EQ(said.pools[0].blocks, 512U);
  EXPECT_EQ(said.pools[1].block_octets, 1008U) << "as they lie in memory";
  const auto none = read_text(R"(<Subsystem name="ARM" id="10"/>)").value.value().resources;
  for (const auto& amount : none.most) EXPECT_FALSE(amount);
  EXPECT_TRUE(none.pools.empty());
  EXPECT_EQ(none.warning_percent, 75U);
  EXPECT_EQ(said.waiting, (Waiting{1024, 128, 1024}));
  EXPECT_EQ(none.waiting, (Waiting{1024, 1024, 1024}));
  EXPECT_EQ(said.channel_kb, 128U);
  EXPECT_EQ(none.channel_kb, std::nullopt) << "as the deployment has it";
}

std::string before_power(const std::string& resources) { return changed("<Power", resources + "\n  <Power"); }

TEST(Resources, AMissionThatLimitsOneHasItSaidByEverySubsystem) {
  const auto reading =
      read_mission(data / "mission.xml", overlay({{"mission.xml", before_power("<Resources threads=\"9\"/>")}}));
  ASSERT_EQ(reading.problems.size(), 3U);
  for (const auto& found : reading.problems) EXPECT_EQ(found.code, "E0350");
}

TEST(Resources, OfProcessesEachSubsystemIsOneWhateverItSays) {
  const auto with = [](const std::string& resources) {
    return read_mission(data / "mission.xml", overlay({{"mission.xml", before_power(resources)}}));
  };
  const auto enough = with("<Resources processes=\"3\"/>");
  ASSERT_TRUE(enough.value) << enough.problems.size();
  EXPECT_EQ(amount_of(enough.value->budget, Resource::Processes), 3U);
  EXPECT_EQ(std::ranges::count(enough.warnings, "E0410", &Diagnostic::code), 0);
  EXPECT_EQ(std::ranges::count(with("<Resources processes=\"2\"/>").warnings, "E0410", &Diagnostic::code), 1);
  EXPECT_FALSE(with("<Resources processes=\"0\"/>").value);
  EXPECT_FALSE(read_text(R"(<Subsystem name="ARM" id="10"><Resources processes="1"/></Subsystem>)").value)
      << "it cannot be another number";
}

TEST(Isolation, IsDemandedByAMissionThatSaysSo) {
  const auto required = [](const std::string& element) {
    return read_mission(data / "mission.xml", overlay({{"mission.xml", before_power(element)}}))
        .value.value()
        .isolation_required;
  };
  EXPECT_FALSE(required(""));
  EXPECT_TRUE(required("<Isolation required=\"yes\"/>"));
  EXPECT_FALSE(required("<Isolation required=\"no\"/>"));
}

TEST(Resources, OfAMissionThatCannotHaveAllAtOnceAreAWarning) {
  std::map<std::string, std::string> files{{"mission.xml", before_power("<Resources threads=\"8\"/>")}};
  const auto source = [&files](const std::filesystem::path& file) -> Result<std::string> {
    const auto changed_one = files.find(file.filename().string());
    std::string text = changed_one != files.end() ? changed_one->second : file_system()(file).value();
    if (file.filename() == "mission.xml" || file.filename() == "supervisor.xml") return text;
    const auto begin = text.find('>', text.find("<Subsystem"));
    return text.insert(begin + 1, "<Resources threads=\"3\"/>");
  };
  auto reading = read_mission(data / "mission.xml", source);
  ASSERT_TRUE(reading.value) << rendered(reading.problems, source);
  EXPECT_EQ(amount_of(reading.value->budget, Resource::Threads), 8U);
  EXPECT_EQ(std::ranges::count(reading.warnings, "E0410", &Diagnostic::code), 1);
  files["mission.xml"] = before_power("<Resources threads=\"9\"/>");
  reading = read_mission(data / "mission.xml", source);
  EXPECT_EQ(std::ranges::count(reading.warnings, "E0410", &Diagnostic::code), 0);
}

}  // namespace
}  // namespace hirosco::descriptor
