// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_graph.hpp"

#include <algorithm>

namespace hirosco::supervisor {

LinkGraph::LinkGraph(const descriptor::Mission& mission) {
  for (const auto& link : mission.links) {
    const auto* from = mission.find_subsystem(link.from);
    const auto* to = mission.find_subsystem(link.to);
    if (from == nullptr || to == nullptr) continue;  // refused when the mission was read
    edges_.push_back({.link = link.id,
                      .from = from->subsystem.id,
                      .to = to->subsystem.id,
                      .required_set = link.requires_,
                      .takes_down = link.on_loss == descriptor::OnLoss::Down});
  }
}

LinkGraph::Edge* LinkGraph::find(std::uint8_t link) noexcept {
  const auto found = std::ranges::find(edges_, link, &Edge::link);
  return found != edges_.end() ? &*found : nullptr;
}

void LinkGraph::set_up(std::uint8_t link, bool up) {
  Edge* edge = find(link);
  if (edge == nullptr) return;
  edge->up = up;
  if (up) edge->from_holds = edge->to_holds = true;
}

void LinkGraph::let_go(std::uint8_t link, std::uint16_t apid) {
  Edge* edge = find(link);
  if (edge == nullptr) return;
  edge->up = false;
  if (edge->from == apid) edge->from_holds = false;
  if (edge->to == apid) edge->to_holds = false;
}

std::uint8_t LinkGraph::standing(std::uint8_t link) const noexcept {
  const auto found = std::ranges::find(edges_, link, &Edge::link);
  if (found == edges_.end()) return 0;
  return static_cast<std::uint8_t>((found->up ? stands_up : 0) | (found->from_holds ? from_holds : 0) |
                                   (found->to_holds ? to_holds : 0));
}

void LinkGraph::stand(std::uint8_t link, std::uint8_t standing) noexcept {
  Edge* edge = find(link);
  if (edge == nullptr) return;
  edge->up = (standing & stands_up) != 0;
  edge->from_holds = (standing & Standing::from_holds) != 0;
  edge->to_holds = (standing & Standing::to_holds) != 0;
}

void LinkGraph::forget(std::uint8_t link) {
  if (Edge* edge = find(link)) edge->up = edge->from_holds = edge->to_holds = false;
}

void LinkGraph::forget_all_of(std::uint16_t apid) {
  for (const Edge& edge : edges_)
    if (edge.from == apid || edge.to == apid) forget(edge.link);
}

std::vector<LinkGraph::HalfHeld> LinkGraph::half_held() const {
  std::vector<HalfHeld> found;
  for (const Edge& edge : edges_)
    if (edge.from_holds != edge.to_holds)
      found.push_back({.link = edge.link,
                       .gone = edge.from_holds ? edge.to : edge.from,
                       .holder = edge.from_holds ? edge.from : edge.to});
  return found;
}

bool LinkGraph::is_up(std::uint8_t link) const noexcept {
  return std::ranges::any_of(edges_, [&](const Edge& edge) { return edge.link == link && edge.up; });
}

bool LinkGraph::holds(std::uint8_t link, std::uint16_t apid) const noexcept {
  return std::ranges::any_of(edges_, [&](const Edge& edge) {
    return edge.link == link && ((edge.from == apid && edge.from_holds) || (edge.to == apid && edge.to_holds));
  });
}

bool LinkGraph::is_held(std::uint8_t link) const noexcept {
  return std::ranges::any_of(edges_, [&](const Edge& edge) { return edge.link == link && edge.joins(); });
}

std::size_t LinkGraph::up_count() const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(edges_, &Edge::up));
}

std::vector<std::uint16_t> LinkGraph::network_of(std::uint16_t apid) const {
  std::vector<std::uint16_t> members{apid};
  for (std::size_t next = 0; next < members.size(); ++next) {
    for (const Edge& edge : edges_) {
      if (!edge.joins()) continue;
      const std::uint16_t other = edge.from == members[next] ? edge.to : edge.to == members[next] ? edge.from : apid;
      if (std::ranges::find(members, other) == members.end()) members.push_back(other);
    }
  }
  std::ranges::sort(members);
  return members;
}

std::vector<std::uint16_t> LinkGraph::taken_down_with(std::uint16_t apid) const {
  std::vector<std::uint16_t> members{apid};
  // A consumer who is to go on does so only where each of its links from there says so.
  const auto goes_on = [this](std::uint16_t lost, std::uint16_t other) {
    bool spared = false;
    for (const Edge& edge : edges_) {
      if (!edge.joins() || edge.from != lost || edge.to != other) continue;
      if (edge.takes_down) return false;
      spared = true;
    }
    return spared;
  };
  for (std::size_t next = 0; next < members.size(); ++next) {
    for (const Edge& edge : edges_) {
      if (!edge.joins()) continue;
      const std::uint16_t lost = members[next];
      const std::uint16_t other = edge.from == lost ? edge.to : edge.to == lost ? edge.from : apid;
      if (std::ranges::find(members, other) == members.end() && !goes_on(lost, other)) members.push_back(other);
    }
  }
  std::ranges::sort(members);
  return members;
}

std::vector<std::uint8_t> LinkGraph::links_out_of(const std::vector<std::uint16_t>& members) const {
  const auto within = [&](std::uint16_t apid) { return std::ranges::find(members, apid) != members.end(); };
  std::vector<std::uint8_t> links;
  for (const Edge& edge : edges_)
    if (edge.up && within(edge.from) && !within(edge.to)) links.push_back(edge.link);
  return links;
}

std::vector<std::uint8_t> LinkGraph::links_of(std::uint16_t apid) const {
  std::vector<std::uint8_t> links;
  for (const Edge& edge : edges_)
    if (edge.up && (edge.from == apid || edge.to == apid)) links.push_back(edge.link);
  return links;
}

std::uint8_t LinkGraph::link_into(std::uint16_t consumer, std::string_view required_set) const noexcept {
  std::uint8_t first = 0;
  for (const Edge& edge : edges_) {
    if (edge.to != consumer || edge.required_set != required_set) continue;
    if (edge.up) return edge.link;
    if (first == 0) first = edge.link;
  }
  return first;
}

std::optional<std::uint8_t> LinkGraph::absent_for(std::uint16_t consumer,
                                                  const descriptor::Configuration& configuration) const noexcept {
  for (const descriptor::Requires& wanted : configuration.requires_) {
    const std::uint8_t link = link_into(consumer, wanted.name);
    if (wanted.required && !is_up(link)) return link;
  }
  return std::nullopt;
}

}  // namespace hirosco::supervisor
