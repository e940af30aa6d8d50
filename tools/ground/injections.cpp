// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/ground/injections.hpp"

#include <charconv>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "hirosco/utilities/utf8.hpp"

namespace hirosco::ground {
namespace {

/// A hand that is moved writes a line of some 40 octets 16 times a second.
constexpr std::size_t most_octets_at_once = 65'536;
constexpr std::size_t longest_line = 255;

}  // namespace

Injections::Injections(std::filesystem::path folder, std::vector<std::string> devices, const Clock& clock)
    : folder_{std::move(folder)}, clock_{clock} {
  for (std::string& device : devices) {
    std::error_code failed;
    const auto octets = std::filesystem::file_size(file_of(device), failed);
    read_[std::move(device)] = failed ? 0 : octets;
  }
}

std::vector<StoredFault> Injections::poll() {
  std::vector<StoredFault> found;
  for (auto& [device, read] : read_) {
    std::error_code failed;
    const auto octets = std::filesystem::file_size(file_of(device), failed);
    if (failed || octets == read) continue;
    if (octets < read) read = 0;  // of another flight
    std::ifstream file{file_of(device), std::ios::binary};
    file.seekg(static_cast<std::streamoff>(read));
    std::string text(most_octets_at_once, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t end = rest.find('\n');
      if (end == std::string_view::npos) {
        if (rest.size() == most_octets_at_once) read += rest.size();  // no line of a device
        break;
      }
      const std::string_view line = rest.substr(0, end);
      rest.remove_prefix(end + 1);
      read += end + 1;
      std::int64_t at_ns = 0;
      const auto [after, problem] = std::from_chars(line.data(), line.data() + line.size(), at_ns);
      if (problem != std::errc{} || after == line.data() + line.size()) continue;
      const auto words = line.substr(static_cast<std::size_t>(after - line.data()) + 1).substr(0, longest_line);
      const OnboardTime at = clock_.onboard() - (clock_.now() - TimePoint{Duration{at_ns}});
      found.push_back({at, device, printable_words(words), "ok"});
    }
  }
  return found;
}

}  // namespace hirosco::ground
