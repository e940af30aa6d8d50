// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/data_transfer/channel/channel_pair.hpp"
#include "hirosco/data_transfer/channel/testing/channel_conformance.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/device/testing/flow_conformance.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/data_transfer/memory/testing/memory_conformance.hpp"

namespace hirosco::testing {
namespace {

class PairEnds {
 public:
  Channel& first() { return pair_.supervisor_end(); }
  Channel& second() { return pair_.subsystem_end(); }
  void close_first() { pair_.close_supervisor_end(); }
  const MemoryHandle& memory() { return memory_; }
  bool same_memory(const MemoryHandle& handle) { return handle.block() == memory_.block(); }

 private:
  ChannelPair pair_;
  MemoryHandle memory_ = HeapMemory{}.create("link", 64).value();
};

struct SimulatedFlowTraits {
  using Factory = LocalFlows;
  static constexpr bool knows_its_peer = true;
  static FlowAddress address() { return {Transfer::SharedMemory, "joint1"}; }
};

INSTANTIATE_TYPED_TEST_SUITE_P(Heap, MemoryConformance, HeapMemory);
INSTANTIATE_TYPED_TEST_SUITE_P(Pair, ChannelConformance, PairEnds);
INSTANTIATE_TYPED_TEST_SUITE_P(Simulated, FlowConformance, SimulatedFlowTraits);

TEST(ChannelPair, HoldsAsManyMessagesAsItsCapacity) {
  ChannelPair pair{2};
  EXPECT_TRUE(pair.subsystem_end().send({}));
  EXPECT_TRUE(pair.subsystem_end().send({}));
  EXPECT_EQ(pair.subsystem_end().send({}).error().code, ErrorCode::ResourceExhausted);
  EXPECT_TRUE(pair.supervisor_end().send({})) << "the other direction has a queue of its own";
}

TEST(LocalFlows, KeepsAddressesApart) {
  LocalFlows flows;
  auto device1 = flows.open({Transfer::SharedMemory, "joint1"}, FlowSide::Device).value();
  auto device2 = flows.open({Transfer::SharedMemory, "joint2"}, FlowSide::Device).value();
  auto device3 = flows.open({Transfer::Udp, "joint1"}, FlowSide::Device).value();
  auto subsystem = flows.open({Transfer::SharedMemory, "joint1"}, FlowSide::Subsystem).value();
  ASSERT_TRUE(subsystem->send(std::array{std::byte{1}}));
  std::array<std::byte, 8> buffer{};
  EXPECT_EQ(device2->receive(buffer).value().flow, Flow::None);
  EXPECT_EQ(device3->receive(buffer).value().flow, Flow::None);
  EXPECT_EQ(device1->receive(buffer).value().flow, Flow::New);
}

}  // namespace
}  // namespace hirosco::testing
