// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/testing/housekeeping_rig.hpp"

namespace hirosco::pus {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST_F(Housekeeping, OfTheListingsComesEachFiveHundredCyclesWithFiveSamples) {
  load(listing_2());
  cycle.run(1500);
  ASSERT_EQ(cycle.reports.size(), 3U);
  int interval = 0;
  for (const auto& report : cycle.reports) {
    EXPECT_EQ(report.cycle, 500 * (interval + 1));
    EXPECT_EQ(report.structure, 4711);
    OctetReader reader{report.data};
    EXPECT_EQ(reader.get<std::uint16_t>(), 4711);
    EXPECT_EQ(reader.get<std::int32_t>(), report.cycle) << "once-values belong to the report's cycle";
    EXPECT_EQ(reader.get<double>(), 0.5 * report.cycle);
    for (int sample = 1; sample <= 5; ++sample)
      EXPECT_EQ(reader.get<double>(), 2.0 * (500 * interval + 100 * sample)) << sample;
    EXPECT_TRUE(reader.exhausted());
    ++interval;
  }
}

TEST_F(Housekeeping, InterleavesTheValuesOfASetByGroup) {
  HousekeepingStructure structure = listing_2(1, 4, 2);
  structure.sampled_once.clear();
  structure.sampled_repeatedly[0].parameters.push_back({"CUR_VALUES.STATE", 0, std::uint16_t{0}, {}});
  structure.sampled_repeatedly.push_back({4, {{"CUR_VALUES.STATE", 0, std::uint16_t{0}, {}}}});
  load(structure);
  cycle.run(4);
  ASSERT_EQ(cycle.reports.size(), 1U);
  EXPECT_EQ(to_hex(cycle.reports[0].data),
            "0001"
            "4010000000000000"
            "00000002"   // cycle 2: 4.0, 2
            "4020000000000000"
            "00000004"   // cycle 4: 8.0, 4
            "00000001"
            "00000002"
            "00000003"
            "00000004");
}

TEST_F(Housekeeping, ReportsAsInTheVectors) {
  // A structure of structures: whole parameters of any octets, whatever ids the vectors give them.
  const auto any_id = [](std::uint8_t id, std::vector<descriptor::Parameter::Member> members) {
    descriptor::Parameter parameter;
    parameter.field.type = Type{0};
    parameter.id = id;
    parameter.members = std::move(members);
    return parameter;
  };
  subsystem.id = 1;
  subsystem.parameters = {any_id(1, {{named("", Type::Uint16), 1}}), any_id(2, {{named("", Type::Float), 2}}),
                          any_id(0x10, {{named("", Type::Uint8), 0x10}})};
  struct Source final : SampleSource {
    std::uint8_t next{7};
    std::size_t sample(std::uint16_t parameter, int, MutableOctets to) noexcept override {
      OctetWriter writer{to};
      if (parameter == 0) writer.put(std::uint16_t{1000});
      if (parameter == 1) writer.put(1.5F);
      if (parameter == 2) writer.put(next++);
      return writer.size();
    }
  } source;
  HousekeepingService vectors{subsystem, sampler, verification, sink};
  handle(vectors, vector_of("st03", "ST03-A").octets);
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac068", "1.4 180ac0680105000000012c"))
      << "10 cycles have no 3 equal parts";
  // The same with 12 cycles.
  send(vectors, 1, "012c0000000c0200010001000100020100030100010010", 0);
  handle(vectors, vector_of("st03", "ST03-B").octets);
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac069", "1.4 180ac06901010100000002", "1.8 180ac06902010101"));
  send(vectors, 9, "01012c", 0);
  std::string expected = vector_of("st03", "ST03-D").fields.at("source_data");
  expected.replace(expected.find("0000000a"), 8, "0000000c");
  EXPECT_THAT(sink.take(), ElementsAre("3.10 " + expected));
  for (int i = 0; i < 12; ++i) sampler.tick(source, cycle);
  ASSERT_EQ(cycle.reports.size(), 1U);
  EXPECT_EQ(to_hex(cycle.reports[0].data), vector_of("st03", "ST03-E").fields.at("source_data").get<std::string>());
  handle(vectors, vector_of("st03", "ST03-C").octets);
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac06a", "1.4 180ac06a0105000000012c")) << "50 is no multiple of 3";
}

TEST_F(Housekeeping, ReportsPropertiesAsInTheVector) {
  HousekeepingStructure first = listing_2(1, 10, 1);
  HousekeepingStructure second = listing_2(300, 1000, 1);
  second.enabled = false;
  load(first);
  load(second);
  EXPECT_THAT(ask(33, "020001012c"),
              ElementsAre("3.35 " + vector_of("st03", "ST03-P1").fields.at("source_data").get<std::string>()));
}

TEST_F(Housekeeping, AnnouncingMoreStructuresThanItCarriesIsRejected) {
  handle(service, vector_of("negative", "NEG-17").octets);
  EXPECT_THAT(sink.take(), ElementsAre("1.2 180ac02e0008"));
}

TEST_F(Housekeeping, CreatedBeginsDisabledAndRunsFromItsEnabling) {
  send(service, 1,
       std::string{"0064"
                   "00000004"
                   "01"} +
           state_member + "00");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.3 180ac001", "1.7 180ac001"));
  cycle.run(10);
  EXPECT_THAT(cycle.reports, IsEmpty());
  EXPECT_THAT(ask(5, "010064"), IsEmpty());
  cycle.run(10);
  ASSERT_EQ(cycle.reports.size(), 2U);
  EXPECT_EQ(to_hex(cycle.reports[0].data), "00640000000e");
  EXPECT_THAT(cycle.take_cycles(), ElementsAre(14, 18));
}

TEST_F(Housekeeping, KeepsItsPhaseWhenEnabledAgain) {
  load(listing_2(1, 4, 1));
  cycle.run(3);
  EXPECT_THAT(ask(5, "010001"), IsEmpty());
  cycle.run(1);
  EXPECT_THAT(cycle.take_cycles(), ElementsAre(4));
}

TEST_F(Housekeeping, DiscardsAnUnfinishedReportWhenDisabled) {
  load(listing_2(1, 4, 1));
  cycle.run(3);
  EXPECT_THAT(ask(6, "010001"), IsEmpty());
  cycle.run(9);
  EXPECT_THAT(cycle.take_cycles(), IsEmpty());
  EXPECT_THAT(ask(5, "010001"), IsEmpty());
  cycle.run(4);
  EXPECT_THAT(cycle.take_cycles(), ElementsAre(16));
}

TEST_F(Housekeeping, ChangesItsIntervalAtTheNextBoundary) {
  load(listing_2(1, 4, 2));
  cycle.run(5);
  EXPECT_THAT(ask(31,
                  "01"
                  "0001"
                  "00000006"),
              IsEmpty());
  cycle.run(15);
  EXPECT_THAT(cycle.take_cycles(), ElementsAre(4, 8, 14, 20));
  EXPECT_THAT(ask(31,
                  "02"
                  "0001"
                  "00000005"
                  "0001"
                  "00000000"),
              ElementsAre("1.4 180ac00101050000000001", "1.4 180ac00101050100000001"));
}

TEST_F(Housekeeping, GivesOneShotsBesideThePeriodicReports) {
  HousekeepingStructure simple = listing_2(1, 10, 1);
  simple.sampled_repeatedly.clear();
  load(simple);
  HousekeepingStructure repeated = listing_2(2, 10, 5);
  repeated.enabled = false;
  load(repeated);
  cycle.run(3);
  EXPECT_THAT(ask(27,
                  "020001"
                  "0002"),
              IsEmpty());
  cycle.run(17);
  std::vector<std::pair<int, int>> seen;
  for (const auto& report : cycle.reports) seen.emplace_back(report.cycle, report.structure);
  // The simple one at once, the repeated one after an interval to fill it.
  EXPECT_THAT(seen, ElementsAre(std::pair{4, 1}, std::pair{10, 1}, std::pair{13, 2}, std::pair{20, 1}));
  OctetReader reader{cycle.reports[2].data};
  std::ignore = reader.get(14);
  for (int sample = 1; sample <= 5; ++sample) EXPECT_EQ(reader.get<double>(), 2.0 * (3 + 2 * sample));
}

TEST_F(Housekeeping, GivesAsManyOneShotsAsWereAskedFor) {
  HousekeepingStructure structure = listing_2(1, 3, 3);
  structure.enabled = false;
  load(structure);
  EXPECT_THAT(ask(27,
                  "020001"
                  "0001"),
              IsEmpty());
  cycle.run(20);
  EXPECT_THAT(cycle.take_cycles(), ElementsAre(3, 6));
}

}  // namespace
}  // namespace hirosco::pus
