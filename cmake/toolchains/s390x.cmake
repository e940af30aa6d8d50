# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
#
# IBM Z, the big endian one: nobody flies it, but a byte order that is taken for granted fails here. Beside it -DHIROSCO_SYSROOT=FOLDER (docs/guide/cross_builds.md).
set(HIROSCO_CROSS_PROCESSOR s390x)
include(${CMAKE_CURRENT_LIST_DIR}/debian_cross.cmake)
