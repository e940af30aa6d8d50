// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "hirosco/descriptor/read/read.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/fuzz/problems.hpp"

/// A mission from whatever text comes, beside the descriptors of a good one: what is refused has problems with their places; what is taken is a
/// mission whose parts find each other, and the flight takes it when it reads it again.
namespace {

using namespace hirosco;
using fuzz::expect;

const std::filesystem::path folder = std::filesystem::path{HIROSCO_SOURCE_DIR} / "hirosco/descriptor/testdata";

/// By their names, read once.
[[nodiscard]] std::map<std::string, std::string> descriptors() {
  std::map<std::string, std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator{folder})
    if (auto text = descriptor::file_system()(entry.path())) texts[entry.path().filename().string()] = *std::move(text);
  return texts;
}

void check_taken(const descriptor::Mission& mission) {
  expect(mission.find_mode(mission.initial_mode) != nullptr && mission.find_mode(mission.start_mode) != nullptr,
         "a mission begins in modes that it has");
  std::set<std::uint16_t> apids{mission.supervisor.id};
  for (const auto& member : mission.subsystems)
    expect(apids.insert(member.subsystem.id).second, "each subsystem has a number of its own");
  for (const auto& link : mission.links)
    expect(mission.find_subsystem(link.from) != nullptr && mission.find_subsystem(link.to) != nullptr,
           "a link has two ends");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto others = descriptors();
  const std::filesystem::path file = "folder/fuzzed.xml";
  const std::string text{fuzz::text_of(data, size)};
  const descriptor::FileSource source = [&](const std::filesystem::path& asked) -> Result<std::string> {
    if (asked == file) return text;
    const auto found = others.find(asked.filename().string());
    if (found == others.end()) return fail(ErrorCode::NotFound, "does not exist");
    return found->second;
  };
  const auto reading = descriptor::read_mission(file, source);
  fuzz::check_reading(reading, file, text, source);
  if (!reading.value) return 0;
  check_taken(*reading.value);
  expect(descriptor::read_again(*reading.value, file, text, source).value.has_value(), "what flies can be read again");
  return 0;
}
