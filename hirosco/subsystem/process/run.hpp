// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "hirosco/subsystem/author/subsystem.hpp"

/// The process around a subsystem: threads, clocks and channels of the operating system.
namespace hirosco {

/// Runs a subsystem as the process that the supervisor started; returns the exit code. `arguments` are those of main().
/// The supervisor passes --descriptor FILE --channel FD --vital FD --permit FD.
int run_subsystem(int argc, char** argv, const std::function<std::unique_ptr<Subsystem>()>& make);

/// `int main(int argc, char** argv) { return hirosco::run<Lamp>(argc, argv); }`
template <class T>
int run(int argc, char** argv) {
  return run_subsystem(argc, argv, [] { return std::make_unique<T>(); });
}

}  // namespace hirosco
