// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/descriptor/read/detail/mission_parts.hpp"

/// What keeps subsystems from each other, beyond what their own descriptors say (docs/adr/0081, 0177).
namespace hirosco::descriptor::detail {
namespace {

/// Below them are the system's own. Above, some programs take the number for a negative one.
constexpr std::int64_t least_user = 1000, most_user = 2'147'483'646;
/// Nobody's, by whose number files of strangers are shown, and the one that stands for none where numbers have 16 bits.
constexpr std::array reserved_users{65'534U, 65'535U};

[[nodiscard]] std::optional<UserNumbers> numbers_in(std::string_view text) {
  const auto dash = text.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto first = to_integer(text.substr(0, dash)), last = to_integer(text.substr(dash + 1));
  if (!first || !last || *first < least_user || *last > most_user || *first > *last) return std::nullopt;
  return UserNumbers{static_cast<std::uint32_t>(*first), static_cast<std::uint32_t>(*last)};
}

void each_endnode(const MissionSubsystem& member, auto&& with) {
  for (const Configuration& configuration : member.subsystem.configurations)
    for (const DeviceUse& use : configuration.devices) {
      const std::string& device = member.subsystem.devices[use.device].name;
      with(device, use.endnode);
      for (const Endnode& other : use.fall_backs) with(device, other);
    }
}

void give_users(const xml::Attribute& attribute, MissionDraft& draft) {
  Mission& mission = draft.mission;
  const auto numbers = numbers_in(attribute.value);
  if (!numbers)
    return draft.problems.add(attribute, "E0366", in_quotes(attribute.value) + " are no numbers of users",
                              fmt::format("FIRST-LAST, from {} to {}, for example 60600-60699", least_user, most_user));
  for (const std::uint32_t reserved : reserved_users)
    if (numbers->first <= reserved && reserved <= numbers->last)
      return draft.problems.add(attribute, "E0366", fmt::format("user {} is nobody's to have", reserved),
                                "take others, for example 60600-60699");
  const std::uint64_t there_are = std::uint64_t{numbers->last} - numbers->first + 1;
  if (there_are < mission.subsystems.size())
    return draft.problems.add(
        attribute, "E0366", fmt::format("{} numbers of users for {} subsystems", there_are, mission.subsystems.size()),
        fmt::format("each has one: {}-{}", numbers->first, numbers->first + mission.subsystems.size() - 1));
  mission.users = numbers;
  std::uint32_t next = numbers->first;
  for (MissionSubsystem& member : mission.subsystems) {
    member.user = next++;
    std::string told;
    // No two have an address (E0313), so what is in a folder of its address is one's.
    each_endnode(member, [&](const std::string& device, const Endnode& endnode) {
      const std::string why = why_not_own({endnode.transfer, endnode.address, endnode.framing});
      if (why.empty() || told == device) return;
      told = device;
      draft.problems.add(attribute, "E0367",
                         fmt::format("'{}' cannot be a user of its own: its device '{}' is not for it alone: {}",
                                     member.subsystem.name, device, why),
                         "shared_memory, unix, udp, tcp, or a line below /dev");
    });
  }
}

}  // namespace

void read_isolation(const xml::Element& element, MissionDraft& draft) {
  Attributes attributes{element, draft.problems};
  no_children(element, draft.problems);
  draft.mission.isolation_required = attributes.yes("required", false);
  if (const auto* users = attributes.optional("users"); users != nullptr) give_users(*users, draft);
}

}  // namespace hirosco::descriptor::detail
