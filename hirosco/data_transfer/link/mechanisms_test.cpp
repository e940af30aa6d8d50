// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "hirosco/data_transfer/link/loaned_memory.hpp"
#include "hirosco/data_transfer/link/testing/link_conformance.hpp"
#include "hirosco/data_transfer/link/testing/loan_conformance.hpp"

namespace hirosco::testing {
namespace {

std::string mechanism_name(const ::testing::TestParamInfo<const LinkMechanism*>& tested) {
  return std::string{to_text(tested.param->method())} + "_" + std::string{to_text(tested.param->kind())};
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, LinkConformance,
                         ::testing::ValuesIn(standard_link_mechanisms().begin(), standard_link_mechanisms().end()),
                         mechanism_name);

const LoanedMemory loaned_memory;
INSTANTIATE_TEST_SUITE_P(Loaned, LinkConformance, ::testing::Values(&loaned_memory), mechanism_name);
INSTANTIATE_TEST_SUITE_P(Loaned, LoanConformance, ::testing::Values(&loaned_memory), mechanism_name);

TEST(LinkMechanisms, AreFoundByMethodAndKindAndThereIsOneOfEach) {
  for (const LinkMechanism* mechanism : standard_link_mechanisms())
    EXPECT_EQ(find_link_mechanism(standard_link_mechanisms(), mechanism->method(), mechanism->kind()), mechanism);
  EXPECT_EQ(find_link_mechanism(standard_link_mechanisms(), LinkMethod::Tipc, LinkKind::Latest), nullptr);
  EXPECT_EQ(find_link_mechanism({}, LinkMethod::SharedMemory, LinkKind::Latest), nullptr);
}

}  // namespace
}  // namespace hirosco::testing
