# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
#
# What the toolchain files have in common: Debian's cross compiler, libraries of the other processor in a folder of their own
# (HIROSCO_SYSROOT, which `tools/portable/cross` makes), and qemu-user for what the build itself starts.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR ${HIROSCO_CROSS_PROCESSOR})
set(CMAKE_LIBRARY_ARCHITECTURE ${HIROSCO_CROSS_PROCESSOR}-linux-gnu)
set(CMAKE_CXX_COMPILER ${CMAKE_LIBRARY_ARCHITECTURE}-g++)

# What tries a compiler reads this file anew and knows these variables only.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES HIROSCO_SYSROOT)
if(NOT IS_DIRECTORY "${HIROSCO_SYSROOT}/usr/include")
  message(FATAL_ERROR "HIROSCO_SYSROOT is '${HIROSCO_SYSROOT}', which is no folder with the libraries of ${HIROSCO_CROSS_PROCESSOR}; "
                      "`tools/portable/cross ${HIROSCO_CROSS_PROCESSOR}` makes one in build/cross-${HIROSCO_CROSS_PROCESSOR}/below/root")
endif()
set(CMAKE_SYSROOT ${HIROSCO_SYSROOT})
# Programs are this computer's, all else is the other's.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# A folder of a newer Debian has libraries that want its own C and C++ library, which serve older compilers as well; the compiler would take those
# that it came with.
file(GLOB newest LIST_DIRECTORIES true ${HIROSCO_SYSROOT}/usr/lib/gcc/${CMAKE_LIBRARY_ARCHITECTURE}/*)
foreach(kind IN ITEMS EXE SHARED MODULE)
  foreach(folder IN ITEMS ${HIROSCO_SYSROOT}/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE} ${newest})
    string(APPEND CMAKE_${kind}_LINKER_FLAGS_INIT " -L${folder}")
  endforeach()
endforeach()

find_program(HIROSCO_EMULATOR qemu-${HIROSCO_CROSS_PROCESSOR}-static)
if(HIROSCO_EMULATOR)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${HIROSCO_EMULATOR} -L ${HIROSCO_SYSROOT})
endif()
