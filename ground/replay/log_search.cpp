// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/log_search.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "ground/model/json.hpp"
#include "hirosco/pus/words/describe.hpp"
#include "hirosco/utilities/lower_case.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

/// One question must not hold up the live view.
constexpr std::size_t most_searched = 20'000;

[[nodiscard]] std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream{lower_case(text)};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

}  // namespace

json search_log(const Catalogue& catalogue, Archive& archive, const LogQuery& query) {
  const pus::PacketDescriber describer{catalogue.mission()};
  const auto words = words_of(query.text);
  json packets = json::array();
  json before = nullptr;
  std::size_t searched = 0;
  archive.packets_back(query.to, query.before, query.housekeeping, [&](const StoredPacket& packet) {
    const std::string text = describer.describe(packet.octets);
    const std::string letters = lower_case(text);
    if (std::ranges::all_of(words, [&](const std::string& word) { return letters.find(word) != letters.npos; }))
      packets.push_back({{"number", packet.number},
                         {"t", json_time(packet.t)},
                         {"apid", packet.apid},
                         {"subsystem", catalogue.name_of(packet.apid)},
                         {"service", packet.service},
                         {"subtype", packet.subtype},
                         {"text", text}});
    const bool enough = ++searched == most_searched || packets.size() >= query.limit;
    if (enough) before = packet.number;
    return !enough;
  });
  return {{"packets", std::move(packets)}, {"before", std::move(before)}};
}

}  // namespace hirosco::ground
