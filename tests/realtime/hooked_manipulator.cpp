// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/process/run.hpp"
#include "subsystems/manipulator/manipulator.hpp"

/// The manipulator as it flies, in an executable that counts what its cycle thread takes from the heap.
int main(int argc, char** argv) { return hirosco::run_subsystem(argc, argv, hirosco::make_manipulator); }
