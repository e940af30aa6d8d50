// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/testing/recording_sink.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;
using descriptor::HousekeepingStructure;
using descriptor::ParameterRef;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

descriptor::Field named(const char* name, Type type) {
  descriptor::Field field;
  field.name = name;
  field.type = type;
  return field;
}

/// The paper's Listing 1, in subsystem 2.
descriptor::Subsystem listing_1() {
  descriptor::Subsystem subsystem;
  subsystem.id = 2;
  descriptor::Parameter current;
  current.field = named("CUR_VALUES", Type::Struct);
  current.members = {{named("STATE", Type::Int32), 0}, {named("POSITION", Type::Double), 0}};
  descriptor::Parameter desired;
  desired.field = named("DES_POSITION", Type::Double);
  desired.id = 1;
  subsystem.parameters = {current, desired};
  return subsystem;
}
constexpr const char* cur_values = "00022000";
constexpr const char* state_member = "00020600";
constexpr const char* des_position = "00020a01";

/// The paper's Listing 2.
HousekeepingStructure listing_2(std::uint16_t id = 4711, std::uint32_t interval = 500, std::uint16_t repetitions = 5) {
  HousekeepingStructure structure;
  structure.id = id;
  structure.interval_cycles = interval;
  structure.sampled_once = {{"CUR_VALUES", 0, {}, {}}};
  structure.sampled_repeatedly = {{repetitions, {{"DES_POSITION", 1, {}, {}}}}};
  return structure;
}

/// STATE is the cycle, POSITION half and DES_POSITION twice the cycle, so that a report tells when it was sampled.
struct Cycle final : SampleSource, SampleSink {
  explicit Cycle(HousekeepingSampler& to_tick) : sampler{to_tick} {}
  std::size_t sample(std::uint16_t parameter, int member, MutableOctets to) noexcept override {
    if (broken) return 0;
    OctetWriter writer{to};
    if (parameter == 0 && member != 1) writer.put(static_cast<std::int32_t>(cycle));
    if (parameter == 0 && member != 0) writer.put(0.5 * cycle);
    if (parameter == 1) writer.put(2.0 * cycle);
    return writer.size();
  }
  MutableOctets reserve(std::size_t octets) noexcept override {
    return full ? MutableOctets{} : MutableOctets{buffer}.first(octets);
  }
  void commit(std::uint16_t structure, std::size_t octets) noexcept override {
    reports.push_back({cycle, structure, Bytes(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(octets))});
  }
  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      ++cycle;
      sampler.tick(*this, *this);
    }
  }
  [[nodiscard]] std::vector<int> take_cycles() {
    std::vector<int> cycles;
    for (const auto& report : reports) cycles.push_back(report.cycle);
    reports.clear();
    return cycles;
  }
  struct Sampled {
    int cycle;
    std::uint16_t structure;
    Bytes data;
  };
  HousekeepingSampler& sampler;
  int cycle{0};
  bool full{false};
  bool broken{false};
  Bytes buffer = Bytes(max_housekeeping_octets);
  std::vector<Sampled> reports;
};

struct Housekeeping : ::testing::Test {
  descriptor::Subsystem subsystem{listing_1()};
  HousekeepingSampler sampler;
  Cycle cycle{sampler};
  RecordingSink sink;
  Verification verification{sink};
  HousekeepingService service{subsystem, sampler, verification, sink};

  void load(const HousekeepingStructure& structure) { ASSERT_TRUE(service.load(std::span{&structure, 1}).has_value()); }
  /// Sends with no success reports asked for, and gives what came back: nothing when all is well.
  std::vector<std::string> ask(std::uint8_t subtype, const std::string& hex) {
    send(service, subtype, hex, 0);
    return sink.take();
  }
};

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

TEST_F(Housekeeping, CreationIsRejectedWhole) {
  load(listing_2(1, 10, 1));
  const std::string state{state_member};
  EXPECT_THAT(ask(1,
                  "0001"
                  "00000004"
                  "01" +
                      state + "00"),
              ElementsAre("1.4 180ac00101020000000001"))
      << "exists";
  EXPECT_THAT(ask(1,
                  "0002"
                  "00000004"
                  "02" +
                      state +
                      "000206ff"
                      "00"),
              ElementsAre("1.4 180ac001010101000206ff"));
  EXPECT_THAT(ask(1,
                  "0002"
                  "00000004"
                  "02" +
                      state + state + "00"),
              ElementsAre("1.4 180ac001010201" + state));
  EXPECT_THAT(ask(1,
                  "0002"
                  "00000004"
                  "01" +
                      state +
                      "01"
                      "0002"
                      "01" +
                      state),
              ElementsAre("1.4 180ac001010201" + state));
  EXPECT_THAT(ask(1,
                  "0002"
                  "00000000"
                  "01" +
                      state + "00"),
              ElementsAre("1.4 180ac00101050000000002"))
      << "interval 0";
  EXPECT_THAT(ask(1,
                  "0002"
                  "00000004"
                  "00"
                  "01"
                  "0000"
                  "01" +
                      state),
              ElementsAre("1.4 180ac00101050000000002"));
  EXPECT_THAT(ask(1,
                  "0002"
                  "00000004"
                  "00"
                  "01"
                  "0003"
                  "01" +
                      state),
              ElementsAre("1.4 180ac00101050000000002"));
  EXPECT_THAT(ask(1,
                  "0002"
                  "00000400"
                  "00"
                  "01"
                  "0400"
                  "01" +
                      state),
              ElementsAre("1.4 180ac001010400"))
      << "too long";
  EXPECT_THAT(ask(33, "010002"), ElementsAre("1.4 180ac00101010000000002")) << "none of them was made";
}

TEST_F(Housekeeping, CreationIsRejectedAtEveryWrongLengthAndWithoutParameters) {
  const std::string whole =
      std::string{
          "0002"
          "00000004"
          "01"} +
      state_member +
      "01"
      "0002"
      "01" +
      des_position;
  for (std::size_t octets = 0; octets < whole.size() / 2; ++octets)
    EXPECT_THAT(ask(1, whole.substr(0, 2 * octets)), ElementsAre("1.2 180ac0010008")) << octets;
  EXPECT_THAT(ask(1, whole + "00"), ElementsAre("1.2 180ac0010008"));
  EXPECT_THAT(ask(1,
                  "0002"
                  "00000004"
                  "00"
                  "00"),
              ElementsAre("1.2 180ac00100090006"));
  EXPECT_THAT(ask(1,
                  "0002"
                  "00000004"
                  "00"
                  "01"
                  "0001"
                  "00"),
              ElementsAre("1.2 180ac0010009000a"));
  EXPECT_THAT(ask(1, whole), IsEmpty());
}

TEST_F(Housekeeping, TakesNoMoreStructuresThanItHasSlotsAndReusesTheDeletedOnes) {
  const auto create = [this](int id) {
    Bytes number(2);
    OctetWriter{number}.put(static_cast<std::uint16_t>(id));
    return ask(1, to_hex(number) +
                      "00000004"
                      "01" +
                      state_member + "00");
  };
  for (int id = 1; id <= 32; ++id) EXPECT_THAT(create(id), IsEmpty()) << id;
  EXPECT_THAT(create(33), ElementsAre("1.4 180ac001010400"));
  EXPECT_THAT(ask(3, "010007"), IsEmpty());
  EXPECT_THAT(create(33), ElementsAre("1.4 180ac001010400")) << "the cycle still has the slot";
  cycle.run(1);
  EXPECT_THAT(create(33), IsEmpty());
  EXPECT_THAT(ask(5, "010021"), IsEmpty());
  cycle.run(4);
  EXPECT_THAT(cycle.take_cycles(), ElementsAre(5));
}

TEST_F(Housekeeping, DeletesOnlyWhatIsDisabledAndNotPredefined) {
  load(listing_2(1, 10, 1));
  HousekeepingStructure disabled = listing_2(2, 10, 1);
  disabled.enabled = false;
  load(disabled);
  EXPECT_THAT(ask(1, std::string{"0003"
                                 "00000004"
                                 "01"} +
                         state_member + "00"),
              IsEmpty());
  EXPECT_THAT(ask(3,
                  "05"
                  "0001"
                  "0002"
                  "0003"
                  "0003"
                  "0009"),
              ElementsAre("1.4 180ac00101030000000001", "1.4 180ac001010701", "1.4 180ac00101010300000003",
                          "1.4 180ac00101010400000009", "1.8 180ac00102010104"));
  EXPECT_THAT(ask(33, "010003"), ElementsAre("1.4 180ac00101010000000003"));
}

TEST_F(Housekeeping, AppendsToADisabledStructureOnly) {
  EXPECT_THAT(ask(1, std::string{"0003"
                                 "00000004"
                                 "01"} +
                         state_member + "00"),
              IsEmpty());
  cycle.run(1);
  const std::string more =
      std::string{
          "0003"
          "00"
          "01"
          "0002"
          "01"} +
      des_position;
  EXPECT_THAT(ask(29, more), IsEmpty());
  EXPECT_THAT(ask(29, more), ElementsAre(std::string{"1.4 180ac001010200"} + des_position)) << "already there";
  EXPECT_THAT(ask(9, "010003"), ElementsAre(std::string{"3.10 0003"
                                                        "00"
                                                        "00000004"
                                                        "01"} +
                                            state_member +
                                            "01"
                                            "0002"
                                            "01" +
                                            des_position));
  EXPECT_THAT(ask(5, "010003"), IsEmpty());
  EXPECT_THAT(ask(29, std::string{"0003"
                                  "01"} +
                          cur_values + "00"),
              ElementsAre("1.4 180ac00101030000000003"));
  EXPECT_THAT(ask(29, std::string{"0004"
                                  "01"} +
                          cur_values + "00"),
              ElementsAre("1.4 180ac00101010000000004"));
  cycle.run(4);
  ASSERT_EQ(cycle.reports.size(), 1U);
  EXPECT_EQ(to_hex(cycle.reports[0].data),
            "0003"
            "00000005"
            "4018000000000000"
            "4024000000000000");
}

TEST_F(Housekeeping, IsReplacedByTheStructureOfAConfigurationWithTheSameId) {
  load(listing_2(1, 4, 1));
  load(listing_2(1, 6, 1));
  cycle.run(12);
  EXPECT_THAT(cycle.take_cycles(), ElementsAre(6, 12));
  ASSERT_TRUE(service.clear().has_value());
  cycle.run(12);
  EXPECT_THAT(cycle.take_cycles(), IsEmpty());
}

TEST_F(Housekeeping, WithAnIntervalThatDoesNotFitIsNotLoaded) {
  const HousekeepingStructure uneven = listing_2(1, 10, 3);
  EXPECT_EQ(service.load(std::span{&uneven, 1}).error().code, ErrorCode::OutOfRange);
  const HousekeepingStructure huge = listing_2(1, 1000, 1000);
  EXPECT_EQ(service.load(std::span{&huge, 1}).error().code, ErrorCode::ResourceExhausted);
}

TEST_F(Housekeeping, CountsReportsThatFindNoRoomAndGoesOn) {
  load(listing_2(1, 2, 1));
  cycle.full = true;
  cycle.run(4);
  EXPECT_EQ(sampler.lost_reports(), 2U);
  cycle.full = false;
  cycle.run(2);
  EXPECT_THAT(cycle.take_cycles(), ElementsAre(6));
}

TEST_F(Housekeeping, ReportsZerosForValuesThatCannotBeSampledAndCountsThem) {
  load(listing_2(1, 1, 1));
  cycle.broken = true;
  cycle.run(1);
  EXPECT_EQ(sampler.failed_samples(), 2U);
  EXPECT_EQ(to_hex(cycle.reports.at(0).data),
            "0001"
            "00000000"
            "0000000000000000"
            "0000000000000000");
}

TEST_F(Housekeeping, IsBusyWhileTheCycleTakesNoCommands) {
  load(listing_2(1, 10, 1));
  std::string all = "ff";
  for (int i = 0; i < 255; ++i) all += "0001";
  for (int i = 0; i < 4; ++i) EXPECT_THAT(ask(5, all), IsEmpty()) << i;
  EXPECT_THAT(ask(5, "010001"), IsEmpty());
  EXPECT_THAT(ask(6,
                  "030001"
                  "0001"
                  "0001"),
              ElementsAre("1.4 180ac0010108", "1.4 180ac0010108", "1.8 180ac00102010102"));
  cycle.run(1);
  EXPECT_THAT(ask(6, "010001"), IsEmpty());
}

TEST_F(Housekeeping, OfUnknownSubtypesIsRejected) {
  for (const int subtype : {2, 4, 7, 25, 37, 99}) {
    const auto reply = ask(static_cast<std::uint8_t>(subtype), "");
    ASSERT_EQ(reply.size(), 1U);
    EXPECT_EQ(reply[0].substr(0, 18), "1.2 180ac001000703") << subtype;
  }
}

}  // namespace
}  // namespace hirosco::pus
