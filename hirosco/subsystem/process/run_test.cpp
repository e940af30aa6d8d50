// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/run.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <new>
#include <string>
#include <vector>

#include "hirosco/data_transfer/control/socket_channel.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"
#include "hirosco/subsystem/pages/pages.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

namespace hirosco {
namespace {

/// The process that a supervisor of another build starts. Each test runs it in a child of its own.
struct BuiltApart : ::testing::Test {
  struct Idle final : Subsystem {};

  SealedMemory memory;
  MemoryHandle vital_memory = memory.create("vital", sizeof(VitalPage)).value();
  MemoryHandle permit_memory = memory.create("permit", sizeof(PermitPage)).value();
  Mapping vital = memory.map(vital_memory, Access::ReadWrite).value();
  Mapping permit = memory.map(permit_memory, Access::ReadWrite).value();
  PermitPage* page{nullptr};
  FileDescriptor supervisor, subsystem;

  void SetUp() override {
    GTEST_FLAG_SET(death_test_style, "fast");
    new (vital.octets.data()) VitalPage{};
    page = new (permit.octets.data()) PermitPage{};
    auto ends = SocketChannel::make_pair().value();
    supervisor = std::move(ends.first);
    subsystem = std::move(ends.second);
  }
  [[noreturn]] void run() {
    const std::string file = ::testing::TempDir() + "built_apart.xml";
    std::ofstream{file} << testing::probe_descriptor;
    const auto number = [](int descriptor) { return std::to_string(descriptor); };
    std::vector<std::string> words{"started",
                                   "--descriptor",
                                   file,
                                   "--channel",
                                   number(subsystem.release()),
                                   "--vital",
                                   number(SealedMemory::descriptor(vital_memory)),
                                   "--permit",
                                   number(SealedMemory::descriptor(permit_memory))};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    std::_Exit(
        run_subsystem(static_cast<int>(arguments.size()), arguments.data(), [] { return std::make_unique<Idle>(); }));
  }
};

TEST_F(BuiltApart, PagesOfAnotherVersionEndItWithAWordOfWhatToDo) {
  page->version = page_version + 1;
  EXPECT_EXIT(run(), ::testing::ExitedWithCode(3),
              "the supervisor's pages are of version 4, this program's of version 3: build both from one hirosco");
}

TEST_F(BuiltApart, AMessageOfAnotherVersionIsRefusedByNameOnce) {
  const std::array foreign{std::byte{1}, std::byte{envelope::version + 1},
                           std::byte{0}, std::byte{0},
                           std::byte{0}, std::byte{0},
                           std::byte{0}, std::byte{0}};
  for (int i = 0; i < 2; ++i)
    ASSERT_EQ(::send(supervisor.get(), foreign.data(), foreign.size(), 0), static_cast<ssize_t>(foreign.size()));
  supervisor.reset();  // it ends when it has read them
  EXPECT_EXIT(
      run(), ::testing::ExitedWithCode(0),
      "^started: the supervisor's control channel is of version 2, this program's of version 1: build both from "
      "one hirosco\n$");
}

}  // namespace
}  // namespace hirosco
