// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/run.hpp"
#include "subsystems/manipulator/manipulator.hpp"

int main(int argc, char** argv) { return hirosco::run_subsystem(argc, argv, hirosco::make_manipulator); }
