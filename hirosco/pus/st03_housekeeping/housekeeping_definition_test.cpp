// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st03_housekeeping/housekeeping_definition.hpp"

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>
#include <sstream>
#include <string>
#include <vector>

/// Octets as ECSS-E-ST-70-41C 8.3.2 lays them out; what the service makes of them is in housekeeping_structures_test.cpp.
namespace hirosco::pus {
namespace {

std::vector<std::byte> these_octets(std::initializer_list<int> numbers) {
  std::vector<std::byte> made;
  for (const int number : numbers) made.push_back(static_cast<std::byte>(number));
  return made;
}

/// Its lists in order, ids in hexadecimal, the repetitions of a set in front: "1020304; 2x 5060708; ".
std::string lists_of(const HousekeepingDefinition& definition) {
  std::ostringstream text;
  definition.each_list([&](std::optional<std::uint16_t> repetitions, Octets ids) {
    if (repetitions) text << *repetitions << "x ";
    for (OctetReader reader{ids}; reader.remaining() != 0;) text << std::hex << reader.get<std::uint32_t>();
    text << "; ";
  });
  return text.str();
}

TEST(HousekeepingDefinition, OfANewStructureHasItsInterval) {
  const auto data = these_octets({0, 2, 0, 0, 0, 4, 1, 1, 2, 3, 4, 1, 0, 2, 1, 5, 6, 7, 8});
  const auto read = read_definition(data, DefinitionOf::NewStructure);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->id, 2);
  EXPECT_EQ(read->interval, 4U);
  EXPECT_EQ(lists_of(*read), "1020304; 2x 5060708; ");
}

TEST(HousekeepingDefinition, OfWhatIsAppendedHasNone) {
  const auto data = these_octets({0, 2, 1, 1, 2, 3, 4, 0});
  const auto read = read_definition(data, DefinitionOf::AppendedParameters);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->interval, 0U);
  EXPECT_EQ(lists_of(*read), "1020304; ");
}

TEST(HousekeepingDefinition, ThatIsCutOrHasOctetsBehindItIsRefused) {
  const auto whole = these_octets({0, 2, 0, 0, 0, 4, 1, 1, 2, 3, 4, 0});
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto read = read_definition(Octets{whole}.first(length), DefinitionOf::NewStructure);
    ASSERT_FALSE(read) << length;
    EXPECT_EQ(read.error().code(), FailureCode::DataLength) << length;
  }
  auto longer = whole;
  longer.push_back({});
  EXPECT_EQ(read_definition(longer, DefinitionOf::NewStructure).error().code(), FailureCode::DataLength);
}

TEST(HousekeepingDefinition, OfNoParameterIsRefusedWithThePlaceOfTheEmptyList) {
  const auto position = [](const std::vector<std::byte>& data) {
    const FailureNotice notice = read_definition(data, DefinitionOf::NewStructure).error();
    EXPECT_EQ(notice.code(), FailureCode::IllegalField);
    return OctetReader{notice.data()}.get<std::uint16_t>();
  };
  EXPECT_EQ(position(these_octets({0, 2, 0, 0, 0, 4, 0, 0})), 6);
  EXPECT_EQ(position(these_octets({0, 2, 0, 0, 0, 4, 0, 1, 0, 2, 0})), 10) << "a set of none";
}

TEST(HousekeepingDefinition, IsReportedAsItIsInForce) {
  const std::array table{SampledValue{.wire = 0x01020304}, SampledValue{.wire = 0x05060708}};
  HousekeepingLayout layout;
  layout.begin(table, 2, 4);
  ASSERT_TRUE(layout.add_once(0) && layout.begin_set(2) && layout.add_to_set(1));
  std::array<std::byte, max_housekeeping_octets> room{};
  const Octets written = write_definition(room, layout, true, 8);
  EXPECT_EQ(std::vector(written.begin(), written.end()),
            these_octets({0, 2, 1, 0, 0, 0, 8, 1, 1, 2, 3, 4, 1, 0, 2, 1, 5, 6, 7, 8}));
  EXPECT_EQ(definition_octets(layout), written.size());
}

}  // namespace
}  // namespace hirosco::pus
