# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
#
# 64-bit RISC-V with the extensions GC, little endian; char has no sign. Beside it -DHIROSCO_SYSROOT=FOLDER (docs/guide/cross_builds.md).
set(HIROSCO_CROSS_PROCESSOR riscv64)
# The linker of Debian 12 dies of archives of Debian 13.
find_program(HIROSCO_LLD ld.lld PATHS /usr/lib/llvm-19/bin)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HIROSCO_LLD)
if(NOT HIROSCO_LLD)
  message(FATAL_ERROR "There is no ld.lld, which links for riscv64: install lld-19")
endif()
include(${CMAKE_CURRENT_LIST_DIR}/debian_cross.cmake)
