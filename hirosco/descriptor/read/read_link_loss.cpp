// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "hirosco/descriptor/read/detail/mission_link_reader.hpp"

namespace hirosco::descriptor::detail {

/// What its loss does to the consumer, and whether the consumer's cycle does its part of that.
void MissionLinkReader::read_loss(Attributes& attributes, const SubsystemDescriptor* consumer, MissionLink& link) {
  const xml::Element& element = attributes.element();
  link.on_loss = attributes.one_of("on_loss", OnLoss::Down);
  const auto* hold = attributes.optional("hold_ms");
  const auto* fallback = attributes.optional("fallback");
  if (hold != nullptr)
    link.hold = std::chrono::milliseconds{attributes.integer_or<std::int64_t>("hold_ms", 1, 60'000, 1)};
  if (fallback != nullptr) link.fallback = fallback->value;
  const auto belongs = [&](const xml::Attribute* at, std::string_view name, OnLoss to) {
    if ((at != nullptr) == (link.on_loss == to)) return;
    problems_.add(at != nullptr ? *at : *element.find("on_loss"), "E0340",
                  at != nullptr ? fmt::format("{} without on_loss=\"{}\"", name, to_text(to))
                                : fmt::format("on_loss=\"{}\" without {}", to_text(to), name));
  };
  belongs(hold, "hold_ms", OnLoss::Hold);
  belongs(fallback, "fallback", OnLoss::Fallback);
  if (consumer == nullptr || link.on_loss == OnLoss::Down) return;
  const xml::Attribute& at = *element.find("on_loss");
  const bool goes_on = link.on_loss != OnLoss::Fallback;
  bool waited_for = false;
  for (const Configuration& configuration : consumer->configurations)
    for (const Requires& set : configuration.requires_) {
      if (set.name != link.requires_ || !set.required) continue;
      waited_for = true;
      if (goes_on == (set.missing == MissingPolicy::Hold)) continue;
      problems_.add(
          at, "E0341",
          fmt::format("'{}' {} in configuration '{}' when {} is missing", link.to,
                      goes_on ? "inhibits its actuators" : "goes on acting", configuration.name, set.name),
          goes_on ? "its descriptor has to say missing=\"hold\"" : "its descriptor must not say missing=\"hold\"");
    }
  if (!waited_for)
    problems_.add(at, "E0340",
                  fmt::format("no configuration of '{}' waits for {}: its loss does nothing", link.to, link.requires_),
                  "leave on_loss out");
  if (fallback == nullptr) return;
  const auto* configuration = consumer->find_configuration(fallback->value);
  std::vector<std::string_view> known;
  for (const Configuration& each : consumer->configurations) known.push_back(each.name);
  if (configuration == nullptr)
    return problems_.add(*fallback, "E0316",
                         fmt::format("'{}' has no configuration {}", link.to, in_quotes(fallback->value)),
                         did_you_mean(fallback->value, known));
  if (std::ranges::any_of(configuration->requires_,
                          [&](const Requires& set) { return set.name == link.requires_ && set.required; }))
    problems_.add(*fallback, "E0340",
                  fmt::format("configuration {} waits for {}, too", in_quotes(fallback->value), link.requires_),
                  "name one that does without it");
}

}  // namespace hirosco::descriptor::detail
