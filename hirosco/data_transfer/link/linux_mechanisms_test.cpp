// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "hirosco/data_transfer/link/testing/link_conformance.hpp"
#include "hirosco/data_transfer/link/testing/loan_conformance.hpp"
#include "hirosco/data_transfer/link/testing/queue_conformance.hpp"
#include "hirosco/data_transfer/link/testing/wake_conformance.hpp"
#include "hirosco/utilities/os/sandbox.hpp"

namespace hirosco::testing {
namespace {

std::string mechanism_name(const ::testing::TestParamInfo<const LinkMechanism*>& tested) {
  return std::string{to_text(tested.param->method())} + "_" + std::string{to_text(tested.param->kind())};
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, LinkConformance,
                         ::testing::ValuesIn(standard_link_mechanisms().begin(), standard_link_mechanisms().end()),
                         mechanism_name);

INSTANTIATE_TEST_SUITE_P(Local, LinkConformance,
                         ::testing::ValuesIn(local_link_mechanisms().begin(), local_link_mechanisms().end()),
                         mechanism_name);

std::vector<const LinkMechanism*> mechanisms_of(LinkKind kind) {
  std::vector<const LinkMechanism*> found;
  std::ranges::copy_if(standard_link_mechanisms(), std::back_inserter(found),
                       [kind](const LinkMechanism* mechanism) { return mechanism->kind() == kind; });
  return found;
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, LoanConformance, ::testing::ValuesIn(mechanisms_of(LinkKind::Loaned)),
                         mechanism_name);
INSTANTIATE_TEST_SUITE_P(BuiltIn, QueueConformance, ::testing::ValuesIn(mechanisms_of(LinkKind::Queued)),
                         mechanism_name);

INSTANTIATE_TEST_SUITE_P(BuiltIn, WakeConformance,
                         ::testing::ValuesIn(standard_link_mechanisms().begin(), standard_link_mechanisms().end()),
                         mechanism_name);
INSTANTIATE_TEST_SUITE_P(Local, WakeConformance,
                         ::testing::ValuesIn(local_link_mechanisms().begin(), local_link_mechanisms().end()),
                         mechanism_name);

TEST(LinkMechanisms, AreFoundByMethodAndKindAndThereIsOneOfEach) {
  for (const LinkMechanism* mechanism : standard_link_mechanisms())
    EXPECT_EQ(find_link_mechanism(standard_link_mechanisms(), mechanism->method(), mechanism->kind()), mechanism);
  EXPECT_EQ(find_link_mechanism(standard_link_mechanisms(), LinkMethod::Tipc, LinkKind::Latest), nullptr);
  for (const LinkMechanism* mechanism : standard_link_mechanisms()) {
    const auto* twin = find_link_mechanism(local_link_mechanisms(), mechanism->method(), mechanism->kind());
    ASSERT_NE(twin, nullptr) << "a simulated craft carries what a real one does";
    EXPECT_TRUE(twin->in_memory());
    EXPECT_EQ(twin->max_payload(), mechanism->max_payload());
    EXPECT_EQ(twin->wakes(), mechanism->wakes());
    EXPECT_EQ(twin->ends_at(), mechanism->ends_at());
  }
  EXPECT_EQ(find_link_mechanism({}, LinkMethod::SharedMemory, LinkKind::Latest), nullptr);
}

TEST(LinkMechanisms, SayWhereTheirEndsStandAndNoneThatIsMemoryNeedsAnythingOfASandbox) {
  EXPECT_EQ(ends_of(standard_link_mechanisms(), LinkMethod::Udp), LinkEndsAt::Addresses);
  EXPECT_EQ(ends_of(standard_link_mechanisms(), LinkMethod::SharedMemory), LinkEndsAt::Memory);
  EXPECT_EQ(ends_of(standard_link_mechanisms(), LinkMethod::Tipc), LinkEndsAt::Memory) << "nobody says otherwise";
  for (const LinkMechanism* mechanism : standard_link_mechanisms()) {
    Sandbox sandbox;
    mechanism->let_in(sandbox);
    EXPECT_EQ(sandbox.sockets, (SandboxSockets{.datagrams = mechanism->method() == LinkMethod::Udp}));
    EXPECT_TRUE(sandbox.writable.empty());
    EXPECT_FALSE(sandbox.queues);
  }
}

}  // namespace
}  // namespace hirosco::testing
