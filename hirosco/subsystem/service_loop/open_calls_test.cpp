// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/open_calls.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// What was reported: subtype of ST[01] and to whom.
struct ReportedStages final : pus::TelemetrySink {
  std::vector<std::pair<int, int>> reports;
  void report(std::uint8_t, std::uint8_t subtype, std::uint16_t destination, Octets) override {
    reports.emplace_back(subtype, destination);
  }
};

struct Calls : ::testing::Test {
  static constexpr std::uint8_t all_stages = 0b1111;
  ReportedStages told;
  pus::Verification verification{told};
  OpenCalls calls{verification};
  pus::Request first{.id = 1, .source = 7, .ack = all_stages}, second{.id = 1, .source = 8, .ack = all_stages};
};

TEST_F(Calls, GetOneFinalReportHoweverOftenTheyAreSaidToEnd) {
  calls.started(first);
  calls.completed(first);
  calls.completed(first);
  calls.failed(first, pus::FailureNotice{pus::FailureCode::ExecutionError});
  EXPECT_THAT(told.reports, ElementsAre(std::pair{3, 7}, std::pair{7, 7}));
}

TEST_F(Calls, OfTheSameNumberAreToldApartByWhoAsked) {
  calls.started(first);
  calls.started(second);
  calls.failed(second, pus::FailureNotice{pus::FailureCode::ExecutionError});
  calls.completed(first);
  EXPECT_THAT(told.reports, ElementsAre(std::pair{3, 7}, std::pair{3, 8}, std::pair{8, 8}, std::pair{7, 7}));
}

TEST_F(Calls, ThatAreForgottenFailEach) {
  calls.started(first);
  calls.started(second);
  told.reports.clear();
  calls.abort_all();
  EXPECT_THAT(told.reports, ElementsAre(std::pair{8, 7}, std::pair{8, 8}));
  told.reports.clear();
  calls.abort_all();
  EXPECT_THAT(told.reports, IsEmpty());
}

TEST_F(Calls, AreBoundedWithThoseOfWhichTheCycleHasNotSaidWhetherTheyRun) {
  for (std::uint32_t id = 0; id < OpenCalls::most - 1; ++id) {
    calls.handed_over();
    calls.started({.id = id, .source = 7, .ack = 0});
  }
  EXPECT_TRUE(calls.have_room());
  calls.handed_over();
  EXPECT_FALSE(calls.have_room());
  calls.refused(second, pus::FailureNotice{pus::FailureCode::ExecutionError});
  EXPECT_TRUE(calls.have_room());
  calls.handed_over();
  calls.forget_handed_over();
  EXPECT_TRUE(calls.have_room());
}

}  // namespace
}  // namespace hirosco
