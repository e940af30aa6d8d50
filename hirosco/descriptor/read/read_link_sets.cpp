// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>

#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/descriptor/read/detail/service_reader.hpp"

/// Sets of data that come and go over real-time links.
namespace hirosco::descriptor::detail {
namespace {

constexpr std::size_t max_set_fields = 64;

/// Words of a list that no mechanism has.
template <auto Has>
void expect_built_in(Attributes& attributes, Problems& problems, std::string_view name) {
  using E = std::invoke_result_t<decltype(Has), const LinkMechanism&>;
  const auto* given = attributes.optional(name);
  if (given == nullptr) return;
  const auto has = [](const LinkMechanism* mechanism) { return std::invoke(Has, *mechanism); };
  for (const std::string_view word : words(given->value))
    if (const auto known = from_text<E>(word);
        known && std::ranges::find(standard_link_mechanisms(), *known, has) == standard_link_mechanisms().end())
      problems.not_built_in(*given, word, are_built_in(standard_link_mechanisms(), has));
}

/// The words of `others` with which `one` is carried.
template <class One, class Other, class Pair>
std::string carried_with(One one, const std::vector<Other>& others, Pair pair) {
  std::string found;
  for (const Other other : others) {
    const auto [method, kind] = pair(one, other);
    if (find_link_mechanism(standard_link_mechanisms(), method, kind) == nullptr) continue;
    found += (found.empty() ? "" : " ") + std::string{to_text(other)};
  }
  return found;
}

template <class E>
std::vector<E> all_words() {
  std::vector<E> all;
  for (const auto& row : EnumTexts<E>::table) all.push_back(row.value);
  return all;
}

/// Each method is there for one of the kinds, and each kind has a method: a word that nothing carries in this company is in vain.
void check_pairs(Attributes& attributes, Problems& problems, const LinkTerms& terms) {
  const auto pair = [](LinkMethod method, LinkKind kind) { return std::pair{method, kind}; };
  const auto turned = [](LinkKind kind, LinkMethod method) { return std::pair{method, kind}; };
  if (const auto* at = attributes.optional("methods"))
    for (const LinkMethod method : terms.methods) {
      const std::string carries = carried_with(method, all_words<LinkKind>(), pair);
      if (carries.empty()) return;  // it is not built in at all, and that was told
      if (!carried_with(method, terms.kinds, pair).empty()) continue;
      return problems.add(
          *at, "E0224",
          fmt::format("{} carries no set of kind=\"{}\"", in_quotes(to_text(method)),
                      attributes.optional("kind") != nullptr ? attributes.text("kind") : "latest"),
          fmt::format("'{}' carries {}: leave the method out, or say this kind", to_text(method), carries));
    }
  if (const auto* at = attributes.optional("kind"))
    for (const LinkKind kind : terms.kinds) {
      const std::string by = carried_with(kind, all_words<LinkMethod>(), turned);
      if (by.empty() || !carried_with(kind, terms.methods, turned).empty()) continue;
      return problems.add(*at, "E0224", fmt::format("none of its methods carries kind {}", in_quotes(to_text(kind))),
                          fmt::format("'{}' goes by {}", to_text(kind), by));
    }
}

}  // namespace

LinkTerms LinkSetReader::read_terms(Attributes& attributes) {
  LinkTerms terms;
  terms.methods = attributes.list_of<LinkMethod>("methods", terms.methods);
  terms.kinds = attributes.list_of<LinkKind>("kind", terms.kinds);
  expect_built_in<&LinkMechanism::method>(attributes, problems_, "methods");
  expect_built_in<&LinkMechanism::kind>(attributes, problems_, "kind");
  check_pairs(attributes, problems_, terms);
  const auto* orders = attributes.optional("byte_order");
  constexpr auto native = std::endian::native == std::endian::little ? ByteOrder::Little : ByteOrder::Big;
  if (std::ranges::find(terms.kinds, LinkKind::Loaned) != terms.kinds.end()) {
    if (terms.kinds.size() != 1)
      problems_.add(*attributes.optional("kind"), "E0231", "a set that is lent is of no other kind besides",
                    "kind=\"loaned\", and a second set for who needs a copy");
    if (orders != nullptr && orders->value != "native")
      problems_.add(*orders, "E0231", "a lent sample has the byte order of the machine",
                    "byte_order=\"native\", or leave it out");
    terms.kinds = {LinkKind::Loaned};
    terms.byte_orders = {native};
    return terms;
  }
  if (orders == nullptr) return terms;
  if (orders->value != "native") terms.byte_orders = attributes.list_of<ByteOrder>("byte_order", terms.byte_orders);
  else terms.byte_orders = {native};
  return terms;
}

/// Of a required set. Who wants every sample has another port than who wants the newest.
std::uint32_t LinkSetReader::read_depth(Attributes& attributes, LinkTerms& terms) {
  const auto* depth = attributes.optional("depth");
  if (std::ranges::find(terms.kinds, LinkKind::Queued) == terms.kinds.end()) {
    if (depth != nullptr)
      problems_.add(*depth, "E0233", "a set that is not queued has no depth", "kind=\"queued\", or leave it out");
    return 0;
  }
  if (terms.kinds.size() != 1)
    problems_.add(*attributes.optional("kind"), "E0233", "a required set that is queued is of no other kind besides",
                  "kind=\"queued\", and a second set for the newest sample");
  terms.kinds = {LinkKind::Queued};
  return attributes.integer_or<std::uint32_t>("depth", min_link_depth, max_link_depth, default_link_depth);
}

void LinkSetReader::read_provides(const xml::Element& element, Services& services) {
  Attributes attributes{element, problems_};
  Provides set;
  set.at = place(element.at);
  set.name = attributes.name();
  set.terms = read_terms(attributes);
  if (!set.name.empty()) services.provided.add(set.name, set.at, problems_, element.name.size() + 1);
  if (set.terms.lent()) {
    read_lent(element, set.fields);
    check_lent(element, set.name, set.fields);
    services.provides.push_back(std::move(set));
    return;
  }
  const std::string user = fmt::format("set '{}'", set.name);
  references_.read_sampled(element, set.parameters, user);
  Unique names{"field name", "E0201"};
  std::size_t octets = 0, fields = 0;
  for (const ParameterRef& reference : set.parameters) {
    octets += references_.octets_of(reference);
    fields += fields_of(subsystem_, reference).size();
    if (octets > max_link_payload_octets || fields > max_set_fields) break;
    for (const Field& field : fields_of(subsystem_, reference)) {
      if (!is_carried(field.type))
        problems_.add(reference.at, "E0104",
                      fmt::format("{} provides '{}', which is {}: a real-time link carries numbers", user,
                                  reference.text == field.name ? field.name : reference.text + ", " + field.name,
                                  to_text(field.type)),
                      "a switch as UINT8; words by housekeeping", reference.text.size());
      if (!field.name.empty() &&
          !names.add(field.name, reference.at, problems_, reference.text.size(), "fields of a set are matched by name"))
        break;
    }
  }
  if (octets > max_link_payload_octets)
    problems_.add(element, "E0215", fmt::format("{} takes {} octets or more in one sample", user, octets),
                  fmt::format("at most {}", max_link_payload_octets));
  if (fields > max_set_fields)
    problems_.add(element, "E0215", fmt::format("{} has {} fields or more", user, fields),
                  fmt::format("at most {}", max_set_fields));
  services.provides.push_back(std::move(set));
}

/// What is lent is too large for the dictionary: it has fields of its own.
void LinkSetReader::read_lent(const xml::Element& element, std::vector<Field>& fields) {
  Unique names{"field name", "E0201"};
  each_child(
      element, problems_,
      {{"Field", [&](const auto& child) { fields_.read_plain(child, fields, names, Says::Lent); }, max_set_fields},
       {"ParamRef", [&](const xml::Element& child) {
          problems_.add(child, "E0231", "a set that is lent has fields of its own, no parameters",
                        "<Field name=\"...\" type=\"...\" count=\"...\"/>, or another kind");
        }}});
  if (fields.empty()) problems_.add(element, "E0106", "<Provides> that is lent needs at least one <Field>");
}

void LinkSetReader::check_lent(const xml::Element& element, std::string_view name, const std::vector<Field>& fields) {
  NaturalLayout layout;
  for (const Field& field : fields) layout.add(field.type, field.count);
  if (layout.octets() > max_loaned_payload_octets)
    problems_.add(element, "E0215", fmt::format("set '{}' takes {} octets in one sample", name, layout.octets()),
                  fmt::format("at most {}", max_loaned_payload_octets));
}

void LinkSetReader::read_requires(const xml::Element& element, Services& services) {
  Attributes attributes{element, problems_};
  Requires set;
  set.at = place(element.at);
  set.name = attributes.name();
  if (attributes.optional("from") != nullptr) set.from = attributes.name("from");
  set.terms = read_terms(attributes);
  set.depth = read_depth(attributes, set.terms);
  set.required = attributes.yes("required", true);
  set.age = read_limit(attributes, "age", "age_reduced", set.age);
  set.missing = attributes.one_of("missing", MissingPolicy::Inhibit);
  const Says says = set.terms.lent() ? Says::Lent : Says::Nothing;
  Unique names{"field name", "E0201"};
  each_child(element, problems_,
             {{"Field", [&](const auto& child) { fields_.read_plain(child, set.fields, names, says, NameKind::Way); },
               max_set_fields}});
  if (set.fields.empty()) problems_.add(element, "E0106", "<Requires> needs at least one <Field>");
  if (set.terms.lent()) check_lent(element, set.name, set.fields);
  std::size_t octets = 0;
  for (const Field& field : set.fields) octets += field.octets();
  if (!set.terms.lent() && octets > max_link_payload_octets)
    problems_.add(element, "E0215", fmt::format("set '{}' takes {} octets in one sample", set.name, octets),
                  fmt::format("at most {}", max_link_payload_octets));
  if (set.depth * octets > max_queue_octets)
    problems_.add(element, "E0215",
                  fmt::format("set '{}' takes {} octets in {} samples", set.name, set.depth * octets, set.depth),
                  fmt::format("at most {}: a smaller depth", max_queue_octets));
  if (!set.name.empty()) services.required.add(set.name, set.at, problems_, element.name.size() + 1);
  services.requires_.push_back(std::move(set));
}

}  // namespace hirosco::descriptor::detail
