// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/resource_table.hpp"

#include <gtest/gtest.h>

namespace hirosco::tools {
namespace {

const ResourceRow memory_row{"memory_kB", 65'536, 12'000, 11'000};
const ResourceRow threads_row{.attribute = "threads", .high = 3};

TEST(ResourceTable, HasWhatIsDeclaredAndTheMostThatWasTakenOfAFlightThatIsOver) {
  EXPECT_EQ(resource_heading(Flies::No), "subsystem            in <Resources>           declared  most used   share");
  EXPECT_EQ(resource_line("ARM", memory_row, Flies::No),
            "ARM                  memory_kB                   65536      12000    19 %");
  EXPECT_EQ(resource_line("ARM", threads_row, Flies::No),
            "ARM                  threads                         -          3       -");
}

TEST(ResourceTable, HasWhatIsTakenNowBetweenThemWhileItFlies) {
  EXPECT_EQ(resource_heading(Flies::Yes),
            "subsystem          resource                declared       now most used   share");
  EXPECT_EQ(resource_line("ARM", memory_row, Flies::Yes),
            "ARM                memory_kB                  65536     11000     12000    19 %");
  EXPECT_EQ(resource_line("ARM", threads_row, Flies::Yes),
            "ARM                threads                        -         -         3       -");
  EXPECT_LE(resource_heading(Flies::Yes).size(), 80U);
}

TEST(ResourceTable, IsALineForEachRowForPrograms) {
  EXPECT_EQ(resource_json("ARM", memory_row, Flies::No),
            R"({"subsystem":"ARM","resource":"memory_kB","declared":65536,"high":12000,"percent":19})");
  EXPECT_EQ(resource_json("ARM", memory_row, Flies::Yes),
            R"({"subsystem":"ARM","resource":"memory_kB","declared":65536,"now":11000,"high":12000,"percent":19})");
  EXPECT_EQ(resource_json("ARM", threads_row, Flies::Yes),
            R"({"subsystem":"ARM","resource":"threads","declared":null,"now":null,"high":3,"percent":null})");
}

}  // namespace
}  // namespace hirosco::tools
