// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "hirosco/descriptor/model/response_time.hpp"
#include "hirosco/descriptor/read/detail/mission_reader.hpp"

/// What a mode needs to be flown as it is written: links, power, processor.
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

template <class E>
bool share(const std::vector<E>& ours, const std::vector<E>& theirs) {
  return std::ranges::any_of(ours, [&](E e) { return std::ranges::find(theirs, e) != theirs.end(); });
}

std::string describe(const Field& field) {
  return fmt::format("{}{}{}", to_text(field.type), field.count == 1 ? "" : fmt::format("[{}]", field.count),
                     field.unit.empty() ? "" : " " + field.unit);
}

}  // namespace

std::string mismatch(const SubsystemDescriptor& producer, const Provides& provides, const Requires& requires_,
                     std::optional<LinkMethod> method) {
  std::vector<Field> offered;
  for (const ParameterRef& reference : provides.parameters)
    std::ranges::move(fields_of(producer, reference), std::back_inserter(offered));
  const bool lent = provides.terms.lent() && requires_.terms.lent();
  if (provides.terms.lent()) offered = provides.fields;
  for (const Field& wanted : requires_.fields) {
    const auto found = std::ranges::find(offered, wanted.name, &Field::name);
    if (found == offered.end()) return fmt::format("field '{}' is not in the provided set", wanted.name);
    if (found->type != wanted.type || found->count != wanted.count || found->unit != wanted.unit)
      return fmt::format("field '{}': {} against {}", wanted.name, describe(*found), describe(wanted));
  }
  if (lent && !std::ranges::equal(offered, requires_.fields, {}, &Field::name, &Field::name))
    return "a lent set has the same fields in the same order at both ends";
  if (!share(provides.terms.methods, requires_.terms.methods)) return "no common method";
  if (!share(provides.terms.byte_orders, requires_.terms.byte_orders)) return "no common byte order";
  if (!share(provides.terms.kinds, requires_.terms.kinds)) return "no common kind";
  std::size_t octets = 0;
  for (const Field& field : offered) octets += field.octets();
  if (method) {
    const bool known = std::ranges::find(provides.terms.methods, *method) != provides.terms.methods.end() &&
                       std::ranges::find(requires_.terms.methods, *method) != requires_.terms.methods.end();
    if (!known) return fmt::format("not both ends have method '{}'", to_text(*method));
    const LinkMechanism* mechanism = find_link_mechanism(standard_link_mechanisms(), *method, requires_.kind());
    if (mechanism == nullptr)
      return fmt::format("'{}' does not carry '{}'", to_text(*method), to_text(requires_.kind()));
    if (requires_.starts && !mechanism->wakes())
      return fmt::format("its samples start a cycle, and '{}' wakes nobody", to_text(*method));
    if (octets > mechanism->max_payload())
      return fmt::format("a sample of {} octets is more than the {} of '{}'", octets, mechanism->max_payload(),
                         to_text(*method));
  }
  if (requires_.depth == 0) return {};
  if (octets * requires_.depth > max_queue_octets)
    return fmt::format("{} samples of {} octets are more than {}", requires_.depth, octets, max_queue_octets);
  return {};
}

void MissionReader::check_power(const xml::Element& element, const Mode& mode) {
  if (!mission_.power_budget_w) return;
  const auto& own = mission_.supervisor.configurations;
  double sum_w = own.empty() ? 0 : own.front().power_w;
  for (const CommissionStep& step : mode.commission) {
    const auto* member = mission_.find_subsystem(step.subsystem);
    const auto* configuration = member == nullptr ? nullptr : member->subsystem.find_configuration(step.configuration);
    if (configuration != nullptr && step.state != State::PreOperational) sum_w += configuration->power_w;
  }
  if (sum_w <= *mission_.power_budget_w) return;
  problems_.add(element, "E0318",
                fmt::format("mode {} commissions {} W, the budget is {} W", in_quotes(mode.name), sum_w,
                            *mission_.power_budget_w),
                "the sum of power_W of its configurations and the supervisor's; Pre-Operational does not count");
}

void MissionReader::check_cycles(const xml::Element& element, const Mode& mode) {
  const double share = cycle_share(mission_, mode);
  if (share > 1)
    return problems_.add(
        element, "E0324",
        fmt::format("the cycles of mode {} take {:.0f} % of a processor", in_quotes(mode.name), 100 * share),
        "all cycles share one: the sum of budget_us / sampling_us is at most 1, or of budget_us / least_us where "
        "samples start the cycle");
  for (const CycleResponse& cycle : cycle_responses(mission_, mode)) {
    if (cycle.longest) continue;
    problems_.add(
        element, "E0331",
        fmt::format("in mode {} a {} of {} {} may not end within its {} us", in_quotes(mode.name),
                    cycle.loop != nullptr ? "step of the loop" : "cycle", cycle.subsystem, in_quotes(cycle.name()),
                    cycle.period() / 1us),
        "others go before it: lower a budget_us, or give the shorter sampling_us (least_us) the higher priority; "
        "`hirosco check --show` tells what each takes");
  }
}

void MissionReader::check_required(const Mode& mode) {
  for (const CommissionStep& step : mode.commission) {
    const auto [subsystem, configuration] = commissioned_in(mission_, mode, step.subsystem);
    if (configuration == nullptr || step.state == State::PreOperational) continue;
    for (const Requires& set : configuration->requires_) {
      const auto into_set = [&](const MissionLink& link) {
        return link.to == step.subsystem && link.requires_ == set.name;
      };
      const bool established = std::ranges::any_of(mode.establish, [&](std::uint8_t id) {
        const auto* link = mission_.find_link(id);
        return link != nullptr && into_set(*link);
      });
      if (established || !set.required) continue;
      const auto known = std::ranges::find_if(mission_.links, into_set);
      problems_.add(step.at, "E0321",
                    fmt::format("mode {} brings up no link into '{}.{}', which configuration '{}' requires",
                                in_quotes(mode.name), step.subsystem, set.name, step.configuration),
                    known == mission_.links.end() ? fmt::format("add a <Link> to it, and <Establish> it here")
                                                  : fmt::format("add <Establish link=\"{}\"/>", known->id),
                    11);
    }
  }
}

std::string MissionReader::refuse_link(const Mode& mode, const MissionLink& link) const {
  const auto consumer = commissioned_in(mission_, mode, link.to), producer = commissioned_in(mission_, mode, link.from);
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
  return mismatch(*producer.subsystem, *provided, *required, link.method);
}

void MissionReader::check_established(const xml::Element& element, const Mode& mode) {
  std::map<std::string, std::uint8_t> filled;
  for (const xml::Element& child : element.children) {
    const auto* at = child.name == "Establish" ? child.find("link") : nullptr;
    const auto id = at == nullptr ? std::nullopt : to_integer(at->value);
    const auto* link = id && *id >= 1 && *id <= 255 ? mission_.find_link(static_cast<std::uint8_t>(*id)) : nullptr;
    if (link == nullptr) continue;
    if (std::string why = refuse_link(mode, *link); !why.empty()) {
      problems_.add(*at, "E0322", fmt::format("link {} cannot come up: {}", link->id, why),
                    "commission both ends with the sets that it joins, or leave it out");
      continue;
    }
    const auto [before, first] = filled.try_emplace(link->to + "." + link->requires_, link->id);
    if (!first && before->second != link->id)
      problems_.add(*at, "E0323",
                    fmt::format("links {} and {} both fill '{}'", before->second, link->id, before->first),
                    "one link into each required set");
  }
}

}  // namespace hirosco::descriptor::detail
