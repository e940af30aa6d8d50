// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/testing/housekeeping_rig.hpp"

namespace hirosco::pus {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

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

TEST_F(Housekeeping, OneWithAValueThatNobodyHasIsNotLoadedWithoutIt) {
  HousekeepingStructure unknown = listing_2();
  unknown.sampled_once.push_back({"CUR_VALUES.SPEED", 0, std::uint16_t{2}, {}});
  EXPECT_EQ(service.load(std::span{&unknown, 1}).error().code, ErrorCode::NotFound);
  unknown.sampled_once.pop_back();
  EXPECT_TRUE(service.load(std::span{&unknown, 1}));
}

/// As many structures of as many sets (none: sampled once) of as many values, an octet each.
struct Many {
  int structures, sets, values;
  bool fits;
};

[[nodiscard]] std::string text_of(const Many& many) {
  std::string list, structure, text = R"(<Subsystem name="S" id="2"><ParamRef name="X" id="1" type="INT8"/>)";
  for (int i = 0; i < many.values; ++i) list += R"(<ParamRef name="X"/>)";
  for (int i = 0; i < many.sets; ++i) structure += R"(<SampledNREPTimes nrep="1">)" + list + "</SampledNREPTimes>";
  if (many.sets == 0) structure = "<SampledOnce>" + list + "</SampledOnce>";
  for (int i = 1; i <= many.structures; ++i)
    text += "<HKService id=\"" + std::to_string(i) + "\" interval=\"1\">" + structure + "</HKService>";
  return text + "</Subsystem>";
}

[[nodiscard]] Result<> load_many(const Many& many) {
  descriptor::SubsystemDescriptor subsystem;
  subsystem.id = 2;
  subsystem.parameters.emplace_back().field = named("X", Type::Int8);
  const std::vector<ParameterRef> list(static_cast<std::size_t>(many.values), {"X", 0, {}, {}});
  HousekeepingStructure structure;
  structure.interval_cycles = 1;
  if (many.sets == 0) structure.sampled_once = list;
  structure.sampled_repeatedly.assign(static_cast<std::size_t>(many.sets), {1, list});
  std::vector<HousekeepingStructure> all;
  for (int i = 1; i <= many.structures; ++i) all.emplace_back(structure).id = static_cast<std::uint16_t>(i);
  HousekeepingSampler sampler;
  RecordingSink sink;
  Verification verification{sink};
  return HousekeepingService{subsystem, sampler, verification, sink}.load(all);
}

/// What the reader refuses is what would not fly, and no less (docs/adr/0032).
TEST(HousekeepingOfADescriptor, IsTakenWhenReadExactlyWhenItCanBeLoaded) {
  const Many all[] = {{32, 0, 1, true},  {33, 0, 1, false},  {1, 0, 255, true}, {1, 0, 256, false},
                      {1, 1, 255, true}, {1, 1, 256, false}, {1, 255, 1, true}, {1, 256, 1, false},
                      {1, 4, 253, true}, {1, 4, 254, false}};
  for (const Many& many : all) {
    SCOPED_TRACE(std::to_string(many.structures) + " of " + std::to_string(many.sets) + " sets of " +
                 std::to_string(many.values));
    const auto reading = descriptor::read_subsystem("test.xml", [&](const auto&) { return text_of(many); });
    EXPECT_EQ(reading.value.has_value(), many.fits);
    EXPECT_TRUE(many.fits || reading.problems.at(0).code == "E0257") << reading.problems.at(0).code;
    EXPECT_EQ(load_many(many).has_value(), many.fits);
  }
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
