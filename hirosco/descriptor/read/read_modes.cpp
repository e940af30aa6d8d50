// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <utility>

#include "hirosco/descriptor/read/detail/mode_parts.hpp"
#include "hirosco/descriptor/read/detail/mode_reader.hpp"

namespace hirosco::descriptor::detail {

void ModeReader::read_modes(const xml::Element& element) {
  Attributes attributes{element, problems_};
  each_child(element, problems_, {{"Mode", [this](const auto& child) { read_mode(child); }, 255}});
  if (mission_.modes.empty()) problems_.add(element, "E0106", "<Modes> needs at least one <Mode>");
  const auto mode = [&](const xml::Attribute* at) {
    if (at == nullptr) return std::string{};
    std::vector<std::string_view> known;
    for (const Mode& candidate : mission_.modes) known.push_back(candidate.name);
    if (mission_.find_mode(at->value) == nullptr)
      problems_.add(*at, "E0305", fmt::format("mode {} is not defined", in_quotes(at->value)),
                    did_you_mean(at->value, known));
    return at->value;
  };
  const auto* initial = attributes.required("initial");
  mission_.initial_mode = mode(initial);
  const auto* start = attributes.optional("start");
  mission_.start_mode = mode(start);
  check_from(element, mission_, problems_);
  if (draft_.whole) check_way_back(mission_, problems_);
  // Where it is the start mode as well that says the same.
  const bool both = mission_.start_mode == mission_.initial_mode;
  if (const Mode* first = mission_.find_mode(mission_.initial_mode); first != nullptr && initial != nullptr && !both)
    check_initial(*initial, *first, problems_);
  if (const Mode* first = mission_.find_mode(mission_.start_mode); first != nullptr && start != nullptr)
    check_start(*start, *first, mission_, problems_);
}

void ModeReader::read_mode(const xml::Element& element) {
  Attributes attributes{element, problems_};
  Mode mode;
  mode.at = place(element.at);
  mode.name = attributes.name("name", NameKind::Loose);
  // Counted from 1 in the order of the file, so that 0 means no mode.
  mode.id = attributes.integer_or<std::uint8_t>("id", 1, 255, static_cast<std::uint8_t>(mission_.modes.size() + 1));
  if (const auto* from = attributes.optional("from"))
    for (const auto word : words(from->value)) mode.from.emplace_back(word);
  const std::size_t before = problems_.count();
  Unique commissioned{"subsystem", "E0201"}, established{"link", "E0202"};
  each_child(
      element, problems_,
      {{"Commission", [&](const auto& child) { read_commission(child, mode, commissioned); }, 255},
       {"Establish", [&](const auto& child) { read_establish(child, mode, established); }, 255},
       {"Needs", [&](const auto& child) { read_interlock(child, Interlock::Kind::Needs, mode, draft_); }, 16},
       {"Excludes", [&](const auto& child) { read_interlock(child, Interlock::Kind::Excludes, mode, draft_); }, 16},
       {"Permit", [&](const auto& child) { read_permit(child, mode, draft_); }, 255}});
  const std::size_t length = element.name.size() + 1;
  if (!mode.name.empty()) mode_names_.add(mode.name, mode.at, problems_, length);
  mode_ids_.add(std::to_string(mode.id), mode.at, problems_, length, "a mode without id has its number in the file");
  check_power(element, mode, mission_, problems_);
  // Only what was read without a problem is judged.
  if (draft_.whole && problems_.count() == before && draft_.doubtful_links == 0) {
    check_cycles(element, mode, mission_, problems_);
    check_required(mode, mission_, problems_);
    check_established(element, mode, mission_, problems_);
    check_shared_memory(element, mode, mission_, problems_);
  }
  mission_.modes.push_back(std::move(mode));
}

State read_steady_state(Attributes& attributes, std::string_view name, State fallback, Problems& problems) {
  const State state = attributes.one_of(name, fallback);
  const auto* at = attributes.optional(name);
  if (at != nullptr && !is_steady(state))
    problems.add(*at, "E0306", fmt::format("{} is passed through, not commanded", to_text(state)),
                 "Offline, PreOperational, SafeOperational, Operational, ErrorOperational or PostOperational");
  return state;
}

void ModeReader::read_commission(const xml::Element& element, Mode& mode, Unique& names) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  CommissionStep step;
  step.at = place(element.at);
  const auto* subsystem = attributes.required("subsystem");
  const auto* configuration = attributes.required("configuration");
  step.state = read_steady_state(attributes, "state", State::Operational, problems_);
  if (step.state == State::ErrorOperational || step.state == State::PostOperational || step.state == State::Offline)
    problems_.add(*element.find("state"), "E0306",
                  fmt::format("commissioning does not lead to {}", to_text(step.state)),
                  "PreOperational, SafeOperational or Operational");
  if (subsystem == nullptr || configuration == nullptr) return;
  step.subsystem = subsystem->value;
  step.configuration = configuration->value;
  names.add(step.subsystem, place(subsystem->value_at), problems_, subsystem->value.size(),
            "one configuration for each subsystem of a mode");
  const SubsystemDescriptor* found = draft_.find(*subsystem, step.subsystem, false);
  if (found != nullptr && found->find_configuration(step.configuration) == nullptr) {
    std::vector<std::string_view> known;
    for (const Configuration& candidate : found->configurations) known.push_back(candidate.name);
    problems_.add(*configuration, "E0316",
                  fmt::format("'{}' has no configuration {}", found->name, in_quotes(step.configuration)),
                  did_you_mean(step.configuration, known));
  }
  mode.commission.push_back(std::move(step));
}

void ModeReader::read_establish(const xml::Element& element, Mode& mode, Unique& ids) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const auto* at = attributes.required("link");
  const auto id = attributes.integer("link", 1, 255);
  if (at == nullptr || !id) return;
  if (mission_.find_link(static_cast<std::uint8_t>(*id)) == nullptr)
    problems_.add(*at, "E0309", fmt::format("link {} is not defined in <Links>", *id));
  ids.add(std::to_string(*id), place(at->value_at), problems_, at->value.size());
  mode.establish.push_back(static_cast<std::uint8_t>(*id));
}

}  // namespace hirosco::descriptor::detail
