// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/people/stacks.hpp"

#include <algorithm>
#include <ranges>

#include "ground/model/json.hpp"

namespace hirosco::ground {

using nlohmann::json;

Stacks::Stacks(Archive& archive) : archive_{archive} {
  for (const StoredMark& mark : archive_.marks("stack", {})) apply(mark);
}

void Stacks::apply(const StoredMark& mark) {
  std::erase_if(kept_, [&](const StoredMark& one) { return one.name == mark.name; });
  if (mark.action == "kept") kept_.push_back(mark);
}

Answered<json> Stacks::keep(const json& body, const std::string& who, OnboardTime now) {
  const std::string name = text_of(body, "name");
  const std::string text = text_of(body, "text");
  if (name.empty() || name.size() > longest_name) return refuse(400, "name: 1 to 80 octets are wanted");
  if (text.size() > longest_text) return refuse(413, "text: at most 20,000 octets are wanted");
  const bool known = std::ranges::find(kept_, name, &StoredMark::name) != kept_.end();
  if (text.empty() && !known) return refuse(404, "name: there is no stack of this name");
  if (!text.empty() && !known && kept_.size() == most_stacks)
    return refuse(409, "there are 64 stacks: forget one before another is kept");
  const StoredMark mark{
      .t = now, .kind = "stack", .name = name, .action = text.empty() ? "forgot" : "kept", .who = who, .note = text};
  archive_.add(mark);
  archive_.commit();
  apply(mark);
  return list();
}

json Stacks::list() const {
  json stacks = json::array();
  for (const StoredMark& one : kept_ | std::views::reverse)
    stacks.push_back({{"name", one.name}, {"text", one.note}, {"t", json_time(one.t)}, {"who", one.who}});
  return {{"stacks", std::move(stacks)}};
}

}  // namespace hirosco::ground
