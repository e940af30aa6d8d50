// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "hirosco/descriptor/read/read.hpp"

using namespace hirosco::descriptor;

int main() {
  const FileSource source = [](const std::filesystem::path&) {
    return hirosco::Result<std::string>{
        "<Subsystem name=\"LIGHT\" id=\"7\">\n"
        "  <ParamRef name=\"GOAL\" id=\"1\" type=\"DUBLE\"/>\n"
        "</Subsystem>\n"};
  };
  const Reading<SubsystemDescriptor> reading = read_subsystem("light.xml", source);
  for (const Diagnostic& problem : reading.problems) std::fputs(render(problem, source, false).c_str(), stdout);
  // light.xml:2:38: error: E0104: unknown parameter type 'DUBLE'
  //     2 |   <ParamRef name="GOAL" id="1" type="DUBLE"/>
  //       |                                      ^~~~~ did you mean 'DOUBLE'?
  return reading.problems.size() == 1 ? 0 : 1;
}
