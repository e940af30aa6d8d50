# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
#
# cmake -D version=0.1.0 -D headers=LIST_FILE -D output=version.cpp -P version.cmake: what version.hpp declares.
file(STRINGS ${headers} files)
set(sums "")
foreach(file IN LISTS files)
  file(SHA256 ${file} sum)
  string(APPEND sums ${sum})
endforeach()
string(SHA256 fingerprint "${sums}")
string(SUBSTRING ${fingerprint} 0 12 fingerprint)
file(CONFIGURE OUTPUT ${output} @ONLY CONTENT [[
#include "hirosco/utilities/version.hpp"

namespace hirosco {

const char version[] = "@version@";
const char interface_version[] = "@version@ interface @fingerprint@";

}  // namespace hirosco
]])
