// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/testing.hpp"

namespace hirosco::descriptor {
namespace {

using namespace testing;

std::string of_subsystem(const std::string& body) {
  return "<Subsystem name=\"ARM\" id=\"10\">" + body + "</Subsystem>";
}

/// "CODE hint" of each problem.
std::string problems_with(const std::string& body) {
  std::string all;
  for (const auto& problem : read_text(of_subsystem(body)).problems) all += problem.code + " " + problem.hint + "\n";
  return all;
}

TEST(Queues, AreAsLargeAsEverWhereNothingIsSaidAndPowersOfTwoWhereSomethingIs) {
  const auto queues = [](const std::string& resources) {
    return read_text(of_subsystem(resources)).value.value().resources.queues;
  };
  EXPECT_EQ(queues(""), (Queues{64, 32'768, 32'768, 65'536, 65'536}));
  EXPECT_EQ(queues(R"(<Resources cycle_commands="100" cycle_answers_kB="40" cycle_events_kB="16"
                       cycle_housekeeping_kB="100" loop_reports_kB="4096"/>)"),
            (Queues{100, 65'536, 16'384, 131'072, 4'194'304}));
}

TEST(Queues, OfWhichNothingIsSaidHoldWhatTheirDescriptorPutsIntoThem) {
  const auto queues = [](const std::string& body) {
    return read_text(of_subsystem(body)).value.value().resources.queues;
  };
  EXPECT_EQ(queues("<Resources cycle_commands=\"1024\"/>").answers_octets, 512U << 10);
}

/// Structures of `octets` octets each, below one id after the other, with the 24 and 8 that a record has beside them.
std::string blocks_of(int how_many, int octets) {
  std::string text = "<ParamRef name=\"BLOCK\" id=\"1\" type=\"UINT8\" count=\"" + std::to_string(octets) + "\"/>";
  for (int i = 1; i <= how_many; ++i)
    text += "<HKService id=\"" + std::to_string(i) + "\" interval=\"" + std::to_string(i) +
            "\"><SampledOnce><ParamRef name=\"BLOCK\"/></SampledOnce></HKService>";
  return text;
}

TEST(Queues, HoldAllHousekeepingThatIsDueInOneCycle) {
  // Record: 8 + 24 + 2 + 4054 = 4088; with the end of the ring one more.
  const std::string as_ever = "<Resources cycle_housekeeping_kB=\"64\"/>";
  EXPECT_EQ(problems_with(as_ever + blocks_of(15, 4054)), "");
  EXPECT_EQ(problems_with(as_ever + blocks_of(16, 4054)),
            "E0369 cycle_housekeeping_kB=\"128\" or more in <Resources>\n");
  EXPECT_EQ(problems_with("<Resources cycle_housekeeping_kB=\"65\"/>" + blocks_of(16, 4054)), "");
}

TEST(Queues, OfOneConfigurationAreThoseThatCount) {
  const std::string eight = blocks_of(8, 4054);
  const auto configuration = [](const char* name, int id, int first) {
    std::string text =
        "<Configuration name=\"" + std::string{name} + "\" id=\"" + std::to_string(id) + "\" sampling_us=\"1000\">";
    for (int i = first; i < first + 7; ++i)
      text += "<HKService id=\"" + std::to_string(i) +
              "\" interval=\"5\"><SampledOnce><ParamRef name=\"BLOCK\"/></SampledOnce></HKService>";
    return text + "</Configuration>";
  };
  EXPECT_EQ(problems_with("<Resources cycle_housekeeping_kB=\"64\"/>" + eight + configuration("A", 1, 20) +
                          configuration("B", 2, 30)),
            "")
      << "15 of one configuration, never 22";
}

std::string events(int how_many, const char* severity) {
  std::string text = "<EventService>";
  for (int i = 1; i <= how_many; ++i)
    text += "<Event name=\"E" + std::to_string(i) + "\" id=\"" + std::to_string(i) + "\" severity=\"" + severity +
            "\"><Argument name=\"A\" type=\"UINT8\" count=\"200\"/></Event>";
  return text + "</EventService>";
}

TEST(Queues, HoldEachEventOfTheAuthorOnceInOneCycleAndRemarksInHalf) {
  // Record: 8 + 224 = 232.
  EXPECT_EQ(problems_with("<Resources cycle_events_kB=\"16\"/>" + events(69, "medium")), "");
  EXPECT_EQ(problems_with("<Resources cycle_events_kB=\"16\"/>" + events(70, "medium")),
            "E0369 cycle_events_kB=\"32\" or more in <Resources>\n");
  EXPECT_EQ(problems_with("<Resources cycle_events_kB=\"16\"/>" + events(34, "low")), "");
  EXPECT_EQ(problems_with("<Resources cycle_events_kB=\"16\"/>" + events(35, "low")),
            "E0369 cycle_events_kB=\"32\" or more in <Resources>\n");
}

TEST(Queues, HoldTheAnswersToAsManyCommandsAsMayWait) {
  EXPECT_EQ(problems_with("<Resources cycle_commands=\"64\"/>"), "");
  EXPECT_EQ(problems_with("<Resources cycle_commands=\"1024\" cycle_answers_kB=\"256\"/>"),
            "E0369 cycle_answers_kB=\"512\" or more in <Resources>\n");
  EXPECT_EQ(problems_with("<Resources cycle_commands=\"1024\" cycle_answers_kB=\"512\"/>"), "");
}

TEST(Queues, HoldTheCommandsThatAttachItsLinks) {
  std::string links = "<RealTimeLinkService>";
  for (int i = 0; i < 20; ++i)
    links += "<Requires name=\"R" + std::to_string(i) + "\"><Field name=\"X\" type=\"INT8\"/></Requires>";
  links += "</RealTimeLinkService><Configuration name=\"C\" id=\"1\" sampling_us=\"1000\"/>";
  EXPECT_EQ(problems_with("<Resources cycle_commands=\"23\"/>" + links),
            "E0369 cycle_commands=\"24\" or more in <Resources>\n");
  EXPECT_EQ(problems_with("<Resources cycle_commands=\"24\"/>" + links), "");
}

TEST(Queues, OfServicesHoldTheAnswersToWhatMayWaitInTheirLoop) {
  const std::string loop = R"(<CustomService name="S" type="200"><Request name="DO" subtype="1"/></CustomService>
    <ServiceLoop name="L" period_us="20000" queue="64"/><Service name="S" loop="L"/>)";
  EXPECT_EQ(problems_with(loop), "");
  EXPECT_EQ(problems_with("<Resources loop_reports_kB=\"32\"/>" + loop),
            "E0369 loop_reports_kB=\"64\" or more in <Resources>\n");
}

TEST(Queues, AreOfTheMemoryThatIsDeclared) {
  EXPECT_EQ(problems_with("<Resources memory_kB=\"4096\" cycle_events_kB=\"1024\" cycle_housekeeping_kB=\"1024\"/>"),
            "");
  EXPECT_EQ(problems_with("<Resources memory_kB=\"4096\" cycle_events_kB=\"2048\" cycle_housekeeping_kB=\"2048\"/>"),
            "E0359 at most 4194304, the memory that it says: fewer of them, or more memory_kB\n");
}

}  // namespace
}  // namespace hirosco::descriptor
