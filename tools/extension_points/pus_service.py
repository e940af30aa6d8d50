# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A service of the framework that adds two numbers: every subsystem has it, permission and words know it."""
WHO = "a PUS service of the framework"
BEFORE = "3 to 4 + 25"
GOAL = "own folder + 1 row; its line in services.md"
MOST_FILES, MOST_EDITED = 4, 1
MOST_ASKED = 1
ASKED = [
    ("docs/services.md", "| ST[128] real-time links |", "| ST[30] sum | 1 ADD | 2 SUM | as mode and state permit |\n| ST[128] real-time links |",
     "pus_test StandardServices.AreTheTableInTheDocuments"),
]
HELD = ["pus_test Table.*", "pus_test Sum.*"]
KEPT = ["tools/check_interfaces.py"]
TRIED_BY = [("hirosco", ["tests/command/permissions_test.py", "{bin}/hirosco", "tests/typed/mission.xml"])]
FILES = {"hirosco/pus/st30_sum/sum_service.hpp": """\
#pragma once

#include "hirosco/pus/st01_verification/verification.hpp"

namespace hirosco::pus {

class SumService final : public Service {
 public:
  static constexpr std::uint8_t service_type = 30;
  static const ServiceKind service_kind;
  explicit SumService(ServiceHome& home) : home_{home} {}
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override;

 private:
  ServiceHome& home_;
};

}  // namespace hirosco::pus
""", "hirosco/pus/st30_sum/sum_service.cpp": """\
#include "hirosco/pus/st30_sum/sum_service.hpp"

#include <array>

#include "hirosco/pus/st01_verification/instructions.hpp"

namespace hirosco::pus {
namespace {
constexpr Part two[]{number("ONE", Type::Uint16), number("OTHER", Type::Uint16)};
constexpr Part sum[]{number("SUM", Type::Uint32)};
constexpr RequestKind requests[]{{1, "ADD", two}};
constexpr ReportKind reports[]{{2, "SUM", sum}};
}  // namespace

const ServiceKind SumService::service_kind{
    .type = service_type, .name = "sum", .requests = requests, .reports = reports,
    .make = [](ServiceHome& home) -> std::unique_ptr<Service> { return std::make_unique<SumService>(home); }};

void SumService::handle(const TelecommandView& telecommand, const Request& request) {
  if (service_kind.request(telecommand.subtype()) == nullptr)
    return home_.verification().rejected(request, unknown_subtype(telecommand));
  OctetReader reader{telecommand.application_data()};
  const std::uint32_t one = reader.get<std::uint16_t>(), other = reader.get<std::uint16_t>();
  if (!reader.exhausted()) return home_.verification().rejected(request, FailureNotice{FailureCode::DataLength});
  home_.verification().accepted(request);
  std::array<std::byte, 4> data;
  OctetWriter{data}.put(one + other);
  home_.telemetry().report(30, 2, request.source, data);
  home_.verification().completed(request);
}

}  // namespace hirosco::pus
""", "hirosco/pus/st30_sum/sum_service_test.cpp": """\
#include "hirosco/pus/st30_sum/sum_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/testing/played_self_test.hpp"
#include "hirosco/pus/testing/recording_sink.hpp"

namespace hirosco::pus {
namespace {

struct SumHome final : ServiceHome {
  const descriptor::SubsystemDescriptor& descriptor() const noexcept override { return subsystem; }
  descriptor::State state() const noexcept override { return descriptor::State::PreOperational; }
  Verification& verification() noexcept override { return stages; }
  TelemetrySink& telemetry() noexcept override { return sink; }
  SelfTest& self_test() noexcept override { return played; }
  FailureNotice refusal(FailureCode code, const Error&) const override { return FailureNotice{code}; }

  descriptor::SubsystemDescriptor subsystem;
  testing::RecordingSink sink;
  Verification stages{sink};
  testing::PlayedSelfTest played;
};

struct Sum : ::testing::Test {
  SumHome home;
  SumService service{home};
};

TEST_F(Sum, IsReportedToWhoAsked) {
  testing::send(service, 1, "fffe0003");
  ASSERT_EQ(home.sink.reports.size(), 3U);
  EXPECT_EQ(home.sink.reports[1].destination, testing::test_source);
  EXPECT_THAT(home.sink.take(), ::testing::ElementsAre("1.1 180ac001", "30.2 00010001", "1.7 180ac001"));
}

TEST_F(Sum, OfOneNumberIsRefused) {
  testing::send(service, 1, "0002");
  EXPECT_THAT(home.sink.take(), ::testing::ElementsAre("1.2 180ac0010008"));
}

}  // namespace
}  // namespace hirosco::pus
""", "hirosco/pus/st30_sum/README.md": """\
# st30_sum

ST[30] adds two numbers.

| Message | Clause of ECSS-E-ST-70-41C | Asked for by | What is tailored here | Proof |
|---|---|---|---|---|
| TC[30,1] ADD | own, this page | whom the mode permits | two numbers, no list | `Sum.IsReportedToWhoAsked`, `Sum.OfOneNumberIsRefused` |
| TM[30,2] SUM | own, this page | - | cannot overflow | `Sum.IsReportedToWhoAsked` |
"""}
EDITS = [
    ("hirosco/pus/standard_services.cpp", '#include "hirosco/pus/st20_parameter/parameter_service.hpp"\n',
     '#include "hirosco/pus/st20_parameter/parameter_service.hpp"\n#include "hirosco/pus/st30_sum/sum_service.hpp"\n'),
    ("hirosco/pus/standard_services.cpp", "                          OfType{st128::service_type,",
     "                          OfType{SumService::service_type, &SumService::service_kind},\n                          OfType{st128::service_type,"),
]
SOURCES = ["hirosco/pus/standard_services.cpp", "hirosco/pus/st30_sum/sum_service.cpp", "hirosco/pus/st30_sum/sum_service_test.cpp"]
TRY = """\
#include <gtest/gtest.h>

#include "hirosco/pus/words/describe.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "supervisor/supervision/data_handling/permission.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco {
namespace {

TEST(NewService, IsAnsweredPermittedAndNamed) {
  struct : Subsystem {} author;
  testing::Rig rig{author, "<Subsystem name=\\"BARE\\" id=\\"10\\"><Configuration name=\\"ONE\\" id=\\"1\\" sampling_us=\\"1000\\"/></Subsystem>"};
  const std::array data{std::byte{0}, std::byte{2}, std::byte{0}, std::byte{3}};
  const auto sent = rig.send(30, 1, data);
  rig.settle();
  EXPECT_EQ(rig.outcome(sent), "1 7");
  EXPECT_EQ(rig.reports(30, 2).at(0), "00000005");
  auto mission = supervisor::testing::small_mission();
  const supervisor::LinkGraph links{mission};
  const auto packet = supervisor::testing::telecommand(10, 30, 1, data);
  const auto view = pus::TelecommandView::parse(packet).value();
  const supervisor::Situation now{mission, mission.modes[0], links, State::Operational};
  EXPECT_EQ(decide(view, supervisor::Origin::ground(), now).error().code(), pus::FailureCode::WrongMode);
  mission.modes[0].permits.front().services.push_back(30);
  EXPECT_TRUE(decide(view, supervisor::Origin::ground(), now));
  EXPECT_EQ(pus::PacketDescriber{mission}.describe(packet), "TC[30,1] ARM #0 ADD ONE=2 OTHER=3");
}

}  // namespace
}  // namespace hirosco
"""
