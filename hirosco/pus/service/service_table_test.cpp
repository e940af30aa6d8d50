// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/service/service_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::pus {
namespace {

using ::testing::ElementsAre;

class Typed final : public Service {
 public:
  explicit Typed(std::uint8_t type) : kind_{.type = type, .name = "typed", .requests = {}, .reports = {}} {}
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return kind_; }
  void handle(const TelecommandView&, const Request&) override {}

 private:
  ServiceKind kind_;
};

TEST(ServicesOfAProcess, AreFoundByTheirTypeAndSteppedInTheOrderInWhichTheyCame) {
  Typed lowest{0}, housekeeping{3}, own{200}, highest{255};
  ServiceTable table{&own, &housekeeping};
  EXPECT_EQ(table.find(0), nullptr);
  table.add(highest);
  table.add(lowest);
  EXPECT_THAT(table.all(), ElementsAre(&own, &housekeeping, &highest, &lowest));
  for (Service* const service : table.all()) EXPECT_EQ(table.find(service->type()), service);
  EXPECT_EQ(table.find(17), nullptr);
}

TEST(ServicesOfAProcess, OfOneTypeAreAnsweredByTheFirst) {
  Typed first{17}, second{17};
  const ServiceTable table{&first, &second};
  EXPECT_EQ(table.find(17), &first);
  EXPECT_THAT(table.all(), ElementsAre(&first, &second)) << "both have their steps";
}

}  // namespace
}  // namespace hirosco::pus
