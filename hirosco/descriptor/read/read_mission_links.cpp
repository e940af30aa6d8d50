// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/common_link_way.hpp"
#include "hirosco/descriptor/read/detail/mission_link_reader.hpp"

/// Which sets a mission joins, and whether they fit.
namespace hirosco::descriptor::detail {
namespace {

template <class Set>
std::vector<std::string_view> names_of(const std::vector<const Set*>& sets) {
  std::vector<std::string_view> names;
  for (const Set* set : sets) names.push_back(set->name);
  return names;
}

template <class E>
bool share(const std::vector<E>& ours, const std::vector<E>& theirs) {
  return std::ranges::any_of(ours, [&](E e) { return std::ranges::find(theirs, e) != theirs.end(); });
}

std::string describe(const Field& field) {
  return fmt::format("{}{}{}", to_text(field.type), field.count == 1 ? "" : fmt::format("[{}]", field.count),
                     field.unit.empty() ? "" : " " + field.unit);
}

template <class E>
std::string joined_words(const std::vector<E>& list) {
  std::string text;
  for (const E each : list) text += (text.empty() ? "" : " ") + std::string{to_text(each)};
  return text;
}

/// An end as the reason names it, with the way on which it insists.
std::string describe(const SubsystemDescriptor& subsystem, const std::string& set, const LinkTerms& terms) {
  return fmt::format("'{}.{}' (methods \"{}\", kind \"{}\")", subsystem.name, set, joined_words(terms.methods),
                     joined_words(terms.kinds));
}

std::string describe(const SubsystemDescriptor& subsystem, const std::string& set, const Configuration& in) {
  return fmt::format("'{}.{}' ({} us in '{}')", subsystem.name, set, in.sampling / 1us, in.name);
}

/// Of methods and kinds of which some are common: why nothing goes all the same, and the mechanism by which it does.
std::string no_way(const LinkEnds& ends, std::optional<LinkMethod> method, const LinkMechanism*& mechanism) {
  const Requires& wanted = ends.requires_;
  LinkTerms offered = ends.provides.terms;
  if (method) offered.methods = {*method};
  if (const auto way = first_common_way(offered, wanted.terms, wanted.starts, carried_here)) {
    mechanism = find_link_mechanism(standard_link_mechanisms(), way->method, way->kind);
    return {};
  }
  const bool only_deaf = wanted.starts && first_common_way(offered, wanted.terms, false, carried_here);
  if (method && only_deaf) return fmt::format("its samples start a cycle, and '{}' wakes nobody", to_text(*method));
  if (method) return fmt::format("'{}' does not carry '{}'", to_text(*method), to_text(wanted.kind()));
  return fmt::format("nothing {} {} and {}", only_deaf ? "wakes a cycle between" : "carries what is common to",
                     describe(ends.producer, ends.provides.name, offered),
                     describe(ends.consumer, wanted.name, wanted.terms));
}

}  // namespace

bool carried_here(LinkMethod method, LinkKind kind, bool wakes) {
  const LinkMechanism* const mechanism = find_link_mechanism(standard_link_mechanisms(), method, kind);
  return mechanism != nullptr && (!wakes || mechanism->wakes());
}

std::vector<Field> fields_of_sample(const SubsystemDescriptor& producer, const Provides& set) {
  if (set.terms.lent()) return set.fields;
  std::vector<Field> fields;
  for (const ParameterRef& reference : set.parameters)
    std::ranges::move(fields_of(producer, reference), std::back_inserter(fields));
  return fields;
}

std::string mismatch(const LinkEnds& ends, std::optional<LinkMethod> method) {
  const auto& [producer, giving, provides, consumer, taking, requires_] = ends;
  const std::vector<Field> offered = fields_of_sample(producer, provides);
  const bool lent = provides.terms.lent() && requires_.terms.lent();
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
  }
  const LinkMechanism* mechanism = nullptr;
  if (std::string why = no_way(ends, method, mechanism); !why.empty()) return why;
  if (octets > mechanism->max_payload())
    return fmt::format("a sample of {} octets is more than the {} of '{}'", octets, mechanism->max_payload(),
                       to_text(mechanism->method()));
  // Who waits for samples has the rate at which they come.
  if (!requires_.starts && !rates_fit(giving.sampling, taking.sampling))
    return fmt::format("one period has to be a multiple of the other, of {} and {}",
                       describe(producer, provides.name, giving), describe(consumer, requires_.name, taking));
  if (requires_.depth == 0) return {};
  if (octets * requires_.depth > max_queue_octets)
    return fmt::format("{} samples of {} octets are more than {}", requires_.depth, octets, max_queue_octets);
  return {};
}

void MissionLinkReader::read_links(const xml::Element& element) {
  const Attributes none{element, problems_};
  each_child(element, problems_, {{"Link", [this](const auto& child) { read_link(child); }, 255}});
}

void MissionLinkReader::read_link(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  MissionLink link;
  link.at = place(element.at);
  link.id = attributes.required_integer<std::uint8_t>("id", 1, 255);
  const std::size_t before = problems_.count();
  const SubsystemDescriptor* producer = read_end(attributes, "from", link.from, link.provides);
  const SubsystemDescriptor* consumer = read_end(attributes, "to", link.to, link.requires_);
  read_way(attributes, link);
  if (producer != nullptr && consumer != nullptr) check_link(element, *producer, *consumer, link);
  read_loss(attributes, consumer, link);
  if (link.id != 0)
    link_ids_.add(std::to_string(link.id), place(element.find("id")->value_at), problems_,
                  element.find("id")->value.size());
  if (problems_.count() != before) ++draft_.doubtful_links;
  mission_.links.push_back(std::move(link));
}

const SubsystemDescriptor* MissionLinkReader::read_end(Attributes& attributes, std::string_view name,
                                                       std::string& subsystem, std::string& set) {
  const auto* at = attributes.required(name);
  if (at == nullptr) return nullptr;
  const std::size_t dot = at->value.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == at->value.size()) {
    problems_.add(*at, "E0110", in_quotes(at->value) + " does not name a set", "SUBSYSTEM.SET is needed");
    return nullptr;
  }
  subsystem = at->value.substr(0, dot);
  set = at->value.substr(dot + 1);
  return draft_.find(*at, subsystem, false);
}

void MissionLinkReader::check_link(const xml::Element& element, const SubsystemDescriptor& producer,
                                   const SubsystemDescriptor& consumer, const MissionLink& link) {
  std::vector<std::pair<const Configuration*, const Provides*>> provides;
  std::vector<std::pair<const Configuration*, const Requires*>> requires_;
  std::vector<const Provides*> provided;
  std::vector<const Requires*> required;
  for (const Configuration& configuration : producer.configurations)
    for (const Provides& set : configuration.provides)
      if (set.name == link.provides) provides.emplace_back(&configuration, &set);
      else provided.push_back(&set);
  for (const Configuration& configuration : consumer.configurations)
    for (const Requires& set : configuration.requires_)
      if (set.name == link.requires_) requires_.emplace_back(&configuration, &set);
      else required.push_back(&set);
  if (provides.empty())
    problems_.add(*element.find("from"), "E0307",
                  fmt::format("no configuration of '{}' provides {}", link.from, in_quotes(link.provides)),
                  did_you_mean(link.provides, names_of(provided)));
  if (requires_.empty())
    problems_.add(*element.find("to"), "E0307",
                  fmt::format("no configuration of '{}' requires {}", link.to, in_quotes(link.requires_)),
                  did_you_mean(link.requires_, names_of(required)));
  if (link.from == link.to) problems_.add(*element.find("to"), "E0308", "a link joins two subsystems");
  // A configuration may change a set; one pair that fits is enough, the handshake decides at run time.
  std::string why;
  for (const auto& [taking, wanted] : requires_)
    for (const auto& [giving, offered] : provides) {
      std::string reason = !wanted->from.empty() && wanted->from != link.from
                               ? fmt::format("'{}' is required from '{}'", wanted->name, wanted->from)
                               : mismatch({producer, *giving, *offered, consumer, *taking, *wanted}, link.method);
      if (reason.empty()) return;
      if (why.empty()) why = std::move(reason);
    }
  if (!why.empty()) problems_.add(element, "E0308", fmt::format("link {} does not fit: {}", link.id, why));
}

}  // namespace hirosco::descriptor::detail
