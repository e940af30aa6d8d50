// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_renewals.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace hirosco::supervisor {

void LinkRenewals::left(std::uint8_t link, std::uint16_t holder) { waiting_[link] = {.holder = holder}; }

void LinkRenewals::let_go(std::uint8_t link, std::uint16_t apid) {
  const auto found = waiting_.find(link);
  if (found != waiting_.end() && found->second.holder == apid) found->second.holder = 0;
}

std::uint16_t LinkRenewals::holder(std::uint8_t link) const {
  const auto found = waiting_.find(link);
  return found != waiting_.end() ? found->second.holder : std::uint16_t{0};
}

LinkRenewals::Judged LinkRenewals::judge(const descriptor::MissionLink& link, const End& from, const End& to) {
  const auto found = waiting_.find(link.id);
  if (found == waiting_.end()) return {};
  if (!from.there || !to.there) return {.next = Next::Over};
  auto& tried = found->second.tried;
  if (!from.settled || !to.settled || from.configuration == 0 || to.configuration == 0) {
    tried.reset();
    return {};
  }
  const std::pair pair{from.configuration, to.configuration};
  if (tried == pair) return {};
  tried = pair;
  const auto* provider = from.described->find_configuration(from.configuration);
  const auto* requirer = to.described->find_configuration(to.configuration);
  if (provider == nullptr || requirer == nullptr) return {};
  if (std::ranges::find(provider->provides, link.provides, &descriptor::Provides::name) == provider->provides.end())
    return {Next::Refused,
            fmt::format("configuration {} of {} does not provide {}", provider->name, link.from, link.provides)};
  if (std::ranges::find(requirer->requires_, link.requires_, &descriptor::Requires::name) == requirer->requires_.end())
    return {Next::Refused,
            fmt::format("configuration {} of {} does not require {}", requirer->name, link.to, link.requires_)};
  return {.next = Next::Establish};
}

}  // namespace hirosco::supervisor
