// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/link/loaned_link.hpp"
#include "hirosco/data_transfer/link/queued_link.hpp"
#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/descriptor/model/common_link_way.hpp"
#include "hirosco/descriptor/model/cores.hpp"
#include "hirosco/descriptor/model/response_time.hpp"
#include "hirosco/descriptor/read/detail/mission_link_reader.hpp"
#include "hirosco/descriptor/read/detail/mode_parts.hpp"

/// What a mode needs to be flown as it is written: links and their memory, power, processor.
namespace hirosco::descriptor::detail {
namespace {

struct Commissioned {
  const SubsystemDescriptor* subsystem{nullptr};
  const Configuration* configuration{nullptr};
};

Commissioned commissioned_in(const Mission& mission, const Mode& mode, std::string_view subsystem) {
  const auto step = std::ranges::find(mode.commission, subsystem, &CommissionStep::subsystem);
  const auto* member = step == mode.commission.end() ? nullptr : mission.find_subsystem(subsystem);
  if (member == nullptr) return {};
  return {&member->subsystem, member->subsystem.find_configuration(step->configuration)};
}

/// Why a mode cannot bring it up; empty when it can.
std::string refuse_link(const Mission& mission, const Mode& mode, const MissionLink& link) {
  const auto consumer = commissioned_in(mission, mode, link.to), producer = commissioned_in(mission, mode, link.from);
  for (const auto& [end, name] : {std::pair{&producer, &link.from}, {&consumer, &link.to}})
    if (end->configuration == nullptr) return fmt::format("the mode does not commission '{}'", *name);
  const auto provided = std::ranges::find(producer.configuration->provides, link.provides, &Provides::name);
  if (provided == producer.configuration->provides.end())
    return fmt::format("configuration '{}' of '{}' does not provide '{}'", producer.configuration->name, link.from,
                       link.provides);
  const auto required = std::ranges::find(consumer.configuration->requires_, link.requires_, &Requires::name);
  if (required == consumer.configuration->requires_.end())
    return fmt::format("configuration '{}' of '{}' does not require '{}'", consumer.configuration->name, link.to,
                       link.requires_);
  if (!required->from.empty() && required->from != link.from)
    return fmt::format("'{}' is required from '{}'", required->name, required->from);
  return mismatch({*producer.subsystem, *producer.configuration, *provided, *consumer.subsystem,
                   *consumer.configuration, *required},
                  link.method);
}

/// Of a link that comes up: by what, and both ends.
struct LinkInMode {
  LinkEnds ends;
  LinkWay way;
};

std::optional<LinkInMode> link_in(const Mission& mission, const Mode& mode, const MissionLink& link) {
  if (!refuse_link(mission, mode, link).empty()) return std::nullopt;
  const auto consumer = commissioned_in(mission, mode, link.to), producer = commissioned_in(mission, mode, link.from);
  const auto& provides = *std::ranges::find(producer.configuration->provides, link.provides, &Provides::name);
  const auto& wanted = *std::ranges::find(consumer.configuration->requires_, link.requires_, &Requires::name);
  LinkTerms offered = provides.terms;
  if (link.method) offered.methods = {*link.method};
  const auto way = first_common_way(offered, wanted.terms, wanted.starts, carried_here);
  if (!way) return std::nullopt;
  return LinkInMode{
      {*producer.subsystem, *producer.configuration, provides, *consumer.subsystem, *consumer.configuration, wanted},
      *way};
}

/// As the handshake makes it.
std::uint64_t memory_octets(const LinkInMode& link) {
  if (link.way.method != LinkMethod::SharedMemory) return 0;
  std::size_t packed = 0;
  NaturalLayout natural;
  for (const Field& field : fields_of_sample(link.ends.producer, link.ends.provides)) {
    packed += field.octets();
    natural.add(field.type, field.count);
  }
  const auto payload = static_cast<std::uint32_t>(packed);
  switch (link.way.kind) {
    case LinkKind::Latest: return link_memory_octets(payload);
    case LinkKind::Queued: return queued_memory_octets(payload, link.ends.requires_.depth);
    case LinkKind::Loaned: return loaned_memory_octets(static_cast<std::uint32_t>(natural.octets()));
  }
  return 0;
}

}  // namespace

void check_power(const xml::Element& element, const Mode& mode, const Mission& mission, Problems& problems) {
  if (!mission.power_budget_w) return;
  const auto& own = mission.supervisor.configurations;
  double sum_w = own.empty() ? 0 : own.front().power_w;
  for (const CommissionStep& step : mode.commission) {
    const auto* member = mission.find_subsystem(step.subsystem);
    const auto* configuration = member == nullptr ? nullptr : member->subsystem.find_configuration(step.configuration);
    if (configuration != nullptr && step.state != State::PreOperational) sum_w += configuration->power_w;
  }
  if (sum_w <= *mission.power_budget_w) return;
  problems.add(
      element, "E0318",
      fmt::format("mode {} commissions {} W, the budget is {} W", in_quotes(mode.name), sum_w, *mission.power_budget_w),
      "the sum of power_W of its configurations and the supervisor's; Pre-Operational does not count");
}

void check_cycles(const xml::Element& element, const Mode& mode, const Mission& mission, Problems& problems) {
  const std::size_t before_shares = problems.count();
  for (const auto& [core, share] : core_shares(mission, mode)) {
    if (share <= 1) continue;
    problems.add(element, "E0324",
                 fmt::format("the cycles of mode {} take {:.0f} % of {}", in_quotes(mode.name), 100 * share,
                             core ? core_words(core) : "a processor"),
                 core ? "the sum of budget_us / sampling_us of all who are there is at most 1: give some another 'core'"
                      : "all cycles share one: the sum of budget_us / sampling_us is at most 1, or of budget_us / "
                        "least_us where samples start the cycle");
  }
  if (problems.count() != before_shares) return;
  const auto end_in_time = [&](const std::vector<CycleResponse>& cycles, std::string_view when) {
    const std::size_t before = problems.count();
    for (const CycleResponse& cycle : cycles) {
      if (cycle.longest) continue;
      problems.add(
          element, "E0331",
          fmt::format("in mode {}{} a {} of {} {} may not end within its {} us", in_quotes(mode.name), when,
                      cycle.loop != nullptr ? "step of the loop" : "cycle", cycle.subsystem, in_quotes(cycle.name()),
                      cycle.period() / 1us),
          "others go before it: lower a budget_us, or give the shorter sampling_us (least_us) the higher priority; "
          "`hirosco check --show` tells what each takes");
    }
    return problems.count() == before;
  };
  if (!end_in_time(cycle_responses(mission, mode), "")) return;
  static_cast<void>(
      end_in_time(cycle_responses_around(mission, mode), ", while not all that it commissions is configured,"));
}

void check_required(const Mode& mode, const Mission& mission, Problems& problems) {
  for (const CommissionStep& step : mode.commission) {
    const auto [subsystem, configuration] = commissioned_in(mission, mode, step.subsystem);
    if (configuration == nullptr || step.state == State::PreOperational) continue;
    for (const Requires& set : configuration->requires_) {
      const auto into_set = [&](const MissionLink& link) {
        return link.to == step.subsystem && link.requires_ == set.name;
      };
      const bool established = std::ranges::any_of(mode.establish, [&](std::uint8_t id) {
        const auto* link = mission.find_link(id);
        return link != nullptr && into_set(*link);
      });
      if (established || !set.required) continue;
      const auto known = std::ranges::find_if(mission.links, into_set);
      problems.add(step.at, "E0321",
                   fmt::format("mode {} brings up no link into '{}.{}', which configuration '{}' requires",
                               in_quotes(mode.name), step.subsystem, set.name, step.configuration),
                   known == mission.links.end() ? fmt::format("add a <Link> to it, and <Establish> it here")
                                                : fmt::format("add <Establish link=\"{}\"/>", known->id),
                   11);
    }
  }
}

void check_established(const xml::Element& element, const Mode& mode, const Mission& mission, Problems& problems) {
  std::map<std::string, std::uint8_t> filled;
  for (const xml::Element& child : element.children) {
    const auto* at = child.name == "Establish" ? child.find("link") : nullptr;
    const auto id = at == nullptr ? std::nullopt : to_integer(at->value);
    const auto* link = id && *id >= 1 && *id <= 255 ? mission.find_link(static_cast<std::uint8_t>(*id)) : nullptr;
    if (link == nullptr) continue;
    if (std::string why = refuse_link(mission, mode, *link); !why.empty()) {
      problems.add(*at, "E0322", fmt::format("link {} cannot come up: {}", link->id, why),
                   "commission both ends with the sets that it joins, or leave it out");
      continue;
    }
    const auto [before, first] = filled.try_emplace(link->to + "." + link->requires_, link->id);
    if (!first && before->second != link->id)
      problems.add(*at, "E0323", fmt::format("links {} and {} both fill '{}'", before->second, link->id, before->first),
                   "one link into each required set");
  }
}

void check_shared_memory(const xml::Element& element, const Mode& mode, const Mission& mission, Problems& problems) {
  std::map<std::string, std::uint64_t> octets;
  std::set<std::pair<std::string, std::string>> lent;
  for (const std::uint8_t id : std::set<std::uint8_t>{mode.establish.begin(), mode.establish.end()}) {
    const MissionLink* const link = mission.find_link(id);
    const auto found = link == nullptr ? std::nullopt : link_in(mission, mode, *link);
    if (!found) continue;
    const std::uint64_t taken = memory_octets(*found);
    octets[link->to] += taken;
    // A set that is lent has one memory for all its consumers (docs/adr/0094).
    const bool more = found->way.kind != LinkKind::Loaned || lent.emplace(link->from, link->provides).second;
    if (more) octets[link->from] += taken;
  }
  for (const auto& [name, sum] : octets) {
    const auto* member = mission.find_subsystem(name);
    const auto most_kb = amount_of(member->subsystem.resources.most, Resource::SharedMemory);
    if (!most_kb || sum <= std::uint64_t{*most_kb} * 1024) continue;
    problems.add(
        element, "E0377",
        fmt::format("in mode {} the links of '{}' take {} octets of shared memory", in_quotes(mode.name), name, sum),
        fmt::format("at most {}, the shared memory that it says: shorter queues, smaller samples, or "
                    "shared_memory_kB=\"{}\" or more in <Resources>",
                    std::uint64_t{*most_kb} * 1024, (sum + 1023) / 1024));
  }
}

}  // namespace hirosco::descriptor::detail
