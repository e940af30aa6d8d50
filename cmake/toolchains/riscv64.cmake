# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
#
# 64-bit RISC-V with the extensions GC, little endian; char has no sign. Beside it -DHIROSCO_SYSROOT=FOLDER (docs/guide/cross_builds.md).
set(HIROSCO_CROSS_PROCESSOR riscv64)
include(${CMAKE_CURRENT_LIST_DIR}/debian_cross.cmake)
