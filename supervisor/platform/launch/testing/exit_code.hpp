// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco::supervisor::testing {

/// With which a program ends that is started so; -1: it could not be started, which fails the test. Blocks until it has ended.
[[nodiscard]] inline int exit_code_of(const ProcessStart& start) {
  auto process = Process::spawn(start);
  if (!process) {
    ADD_FAILURE() << process.error().text << " " << process.error().value;
    return -1;
  }
  WaitSet set;
  EXPECT_TRUE(set.add(process->handle().get()));
  static_cast<void>(set.wait(std::nullopt));
  return process->poll()->value().value;
}

}  // namespace hirosco::supervisor::testing
