// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <span>
#include <utility>

#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t max_cycles = 1'000'000;
constexpr std::size_t max_arguments = 255;
constexpr std::int64_t max_self_test_ms = 600'000;  // ten minutes
constexpr std::size_t max_structures = 256;
// What ST[03] has room for in flight (hirosco/pus/st03_housekeeping; a test there holds them together).
constexpr std::size_t most_flown_structures = 32;
constexpr std::size_t most_listed_values = 255;  // a count in TM[3,10] is one octet
constexpr std::size_t max_sets = 32;

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

constexpr std::size_t max_set_fields = 64;

/// Of the definition of a structure in TM[3,10]: id, enabled,
/// interval, two counts, and of each set its repetitions and a count.
[[nodiscard]] std::size_t definition_octets_of(const HousekeepingStructure& structure) noexcept {
  std::size_t octets = 2 + 1 + 4 + 1 + 4 * structure.sampled_once.size() + 1;
  for (const auto& set : structure.sampled_repeatedly) octets += 2 + 1 + 4 * set.parameters.size();
  return octets;
}

}  // namespace

std::vector<Child> SubsystemReader::service_children(Services& services) {
  const auto service = [this, &services](auto read) {
    return [this, &services, read](const xml::Element& element) {
      Attributes attributes{element, problems_};
      if (first_service(element, services)) read(element);
    };
  };
  return {{"EventService", service([this, &services](const xml::Element& element) {
             each_child(element, problems_,
                        {{"Event", [this, &services](const auto& child) { read_event(child, services); }}});
           })},
          {"FunctionService", service([this, &services](const xml::Element& element) {
             each_child(element, problems_,
                        {{"Function", [this, &services](const auto& child) { read_function(child, services); }}});
           })},
          {"TestService",
           [this, &services](const xml::Element& element) {
             if (first_service(element, services)) read_test_service(element, services);
           }},
          {"HKService", [this, &services](const xml::Element& element) { read_housekeeping(element, services); },
           max_structures},
          {"RealTimeLinkService", service([this, &services](const xml::Element& element) {
             each_child(
                 element, problems_,
                 {{"Provides", [this, &services](const auto& child) { read_provides(child, services); }, max_sets},
                  {"Requires", [this, &services](const auto& child) { read_requires(child, services); }, max_sets}});
           })}};
}

bool SubsystemReader::first_service(const xml::Element& element, Services& services) {
  const auto [before, first] = services.seen.emplace(element.name, place(element.at));
  if (!first)
    problems_.add(element, "E0212",
                  fmt::format("a second <{}>: a subsystem has one instance of each service", element.name),
                  fmt::format("the first one is in line {}", before->second.line));
  return first;
}

void SubsystemReader::read_test_service(const xml::Element& element, Services& services) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const std::int64_t inherited_ms = services.self_test_within / std::chrono::milliseconds{1};
  services.self_test_within = std::chrono::milliseconds{
      attributes.integer_or<std::int64_t>("self_test_within_ms", 1, max_self_test_ms, inherited_ms)};
}

void SubsystemReader::read_event(const xml::Element& element, const Services& services) {
  Attributes attributes{element, problems_};
  Event event;
  event.at = place(element.at);
  event.name = attributes.name();
  const bool of_framework = element.find("id") == nullptr;
  event.id = attributes.integer_or<std::uint16_t>("id", 1, framework_event::first - 1, 0);
  if (attributes.required("severity") != nullptr) event.severity = attributes.one_of("severity", Severity::Info);
  event.safety = attributes.yes("safety", false);
  Unique names{"argument name", "E0201"};
  each_child(
      element, problems_,
      {{"Argument", [&](const xml::Element& child) { read_plain_field(child, event.arguments, names, Says::Words); },
        max_arguments}});
  std::size_t octets = 0;
  for (const Field& argument : event.arguments) octets += argument.octets();
  if (octets > max_event_octets)
    problems_.add(element, "E0215", fmt::format("event '{}' takes {} octets in one report", event.name, octets),
                  fmt::format("at most {}", max_event_octets));
  expect_for_all(element, services, event.name);
  if (!event.name.empty()) event_names_.add(event.name, event.at, problems_, element.name.size() + 1);
  // Without an id it can only be one of the framework's; those are known when the whole descriptor is.
  if (of_framework) {
    framework_severities_.push_back({&element, std::move(event)});
    return;
  }
  if (event.id != 0)
    event_ids_.add(std::to_string(event.id), place(element.find("id")->value_at), problems_,
                   element.find("id")->value.size());
  subsystem_.events.push_back(std::move(event));
}

/// An author may change the severity of a framework's event, nothing else of it.
void SubsystemReader::imply_framework_events() {
  const std::size_t own = subsystem_.events.size();
  add_framework_events(subsystem_);
  const auto implied = std::span{subsystem_.events}.subspan(own);
  for (const Event& event : std::span{subsystem_.events}.first(own))
    if (std::ranges::find(implied, event.name, &Event::name) != implied.end())
      problems_.add(event.at, "E0213", fmt::format("event '{}' is built in: every subsystem has it", event.name),
                    "leave it out, or give it a severity only: no id, no arguments", 6);
  for (const auto& [element, wanted] : framework_severities_) {
    const auto found = std::ranges::find(implied, wanted.name, &Event::name);
    if (found == implied.end())
      problems_.add(*element, "E0105", "<Event> needs the attribute 'id'",
                    "only an event that every subsystem has is known without it");
    else if (!wanted.arguments.empty())
      problems_.add(*element, "E0213", fmt::format("event '{}' is built in with its arguments", wanted.name));
    else if (const auto* mark = element->find("safety"); mark != nullptr && !wanted.safety && found->safety)
      problems_.add(place(mark->value_at), "E0241", fmt::format("event '{}' is one that safety rests on", wanted.name),
                    "leave safety out: nobody switches its report off", mark->value.size());
    else {
      found->severity = wanted.severity;
      found->safety = found->safety || wanted.safety;
    }
  }
}

void SubsystemReader::read_function(const xml::Element& element, const Services& services) {
  Attributes attributes{element, problems_};
  Function function;
  function.at = place(element.at);
  function.name = attributes.name("name", NameKind::Function);
  function.essential = attributes.yes("essential", false);
  function.confirm = attributes.yes("confirm", false);
  function.states = read_states(attributes, "states", {State::Operational});
  if (const auto* at = attributes.optional("id"); at != nullptr)
    problems_.not_built_in(*at, "leave it out: a function is called by its name");
  Unique names{"argument name", "E0201"};
  each_child(element, problems_,
             {{"Argument", [&](const xml::Element& child) { read_argument(child, function, names); }, max_arguments},
              {"Description",
               [&](const xml::Element& child) {
                 no_children(child, problems_, true);
                 function.description = child.text;
               },
               1}});
  check_arguments(element, function);
  expect_for_all(element, services, function.name);
  if (std::ranges::find(built_in_requests, function.name) != built_in_requests.end())
    problems_.add(*element.find("name"), "E0213",
                  fmt::format("'{}' is built in: every subsystem has it", function.name));
  else if (!function.name.empty()) function_names_.add(function.name, function.at, problems_, element.name.size() + 1);
  subsystem_.functions.push_back(std::move(function));
}

/// Functions and events are the subsystem's, whatever is configured: nothing may look as if it held in one configuration only.
void SubsystemReader::expect_for_all(const xml::Element& element, const Services& services, std::string_view name) {
  if (!services.of_configuration || configurations_ < 2) return;
  problems_.add(element, "E0230",
                fmt::format("'{}' stands in one of {} configurations and would hold in all", name, configurations_),
                "declare it under <Subsystem>; a function that makes no sense now is its author's to refuse");
}

void SubsystemReader::check_arguments(const xml::Element& element, const Function& function) {
  std::size_t octets = 0;
  for (const Function::Argument& argument : function.arguments) octets += argument.octets();
  if (octets > max_argument_octets)
    problems_.add(element, "E0225", fmt::format("the arguments of function '{}' take {} octets", function.name, octets),
                  fmt::format("at most {} in one call", max_argument_octets));
}

std::uint16_t SubsystemReader::read_states(Attributes& attributes, std::string_view name, std::vector<State> fallback) {
  unsigned states = 0;
  for (const State state : attributes.list_of<State>(name, std::move(fallback)))
    states |= 1U << static_cast<unsigned>(state);
  return static_cast<std::uint16_t>(states);
}

void SubsystemReader::read_argument(const xml::Element& element, Function& function, Unique& names) {
  Attributes attributes{element, problems_};
  Function::Argument argument;
  if (element.find("of") != nullptr) read_range_of(attributes, argument, function.name);
  else {
    argument.field = read_field(attributes, Says::Argument);
    const bool named = argument.field.type == Type::Bool || !argument.field.enumeration.empty();
    if (!named && argument.field.type != Type::Text) expect_range(element, "argument");
  }
  read_fallback(attributes, argument);
  no_children(element, problems_);
  if (!argument.field.name.empty())
    names.add(argument.field.name, place(element.at), problems_, element.name.size() + 1);
  function.arguments.push_back(std::move(argument));
}

void SubsystemReader::read_fallback(Attributes& attributes, Function::Argument& argument) {
  const auto* at = attributes.optional("default");
  if (at == nullptr) return;
  Field each = argument.field;
  each.count = 1;
  if (auto values = read_values(problems_, *at, each.name, {&each, 1}, subsystem_.enumerations))
    argument.fallback = std::move(values->front());
}

/// One range for a number wherever it is set: the argument is one value of the parameter.
void SubsystemReader::read_range_of(Attributes& attributes, Function::Argument& argument, const std::string& function) {
  const std::string name = attributes.name();
  const xml::Attribute& at = *attributes.optional("of");
  for (const std::string_view own : {"type", "count", "octets", "unit", "minimum", "maximum", "enumeration"})
    if (const auto* given = attributes.optional(own); given != nullptr)
      problems_.add(place(given->at), "E0220", fmt::format("'{}' has its {} from {}", name, own, in_quotes(at.value)),
                    fmt::format("leave {} or of out", own), own.size());
  if (const auto parameter = resolve(at, fmt::format("argument '{}'", name))) {
    const auto fields = fields_of(subsystem_, *parameter);
    argument.of = at.value;
    if (fields.size() != 1)
      problems_.add(at, "E0221", in_quotes(at.value) + " is a structure", "name one of its members");
    else if (is_carried(fields.front().type) && (!fields.front().minimum || !fields.front().maximum))
      problems_.add(at, "E0221", in_quotes(at.value) + " has no range", "give it minimum and maximum");
    if (!fields.empty()) argument.field = fields.front();
    const Parameter& of = subsystem_.parameters[parameter->parameter];
    const std::string& setter = raised_by_.try_emplace(parameter->parameter, function).first->second;
    if (of.protection && setter != function)
      problems_.add(at, "E0219", fmt::format("'{}' is a protection and '{}' sets it already", of.field.name, setter),
                    "a protection is raised by one function only");
  }
  argument.field.name = name;
  argument.field.count = 1;
  argument.field.at = place(attributes.element().at);
}

void SubsystemReader::read_housekeeping(const xml::Element& element, Services& services) {
  Attributes attributes{element, problems_};
  HousekeepingStructure structure;
  structure.at = place(element.at);
  structure.id = attributes.required_integer<std::uint16_t>("id", 1, 65'535);
  structure.interval_cycles = attributes.required_integer<std::uint32_t>("interval", 1, 4'294'967'295);
  structure.enabled = attributes.yes("enabled", true);
  const std::string user = fmt::format("HKService {}", structure.id);
  each_child(element, problems_,
             {{"SampledOnce",
               [&](const xml::Element& child) {
                 const Attributes none{child, problems_};
                 read_sampled(child, structure.sampled_once, user);
               },
               1},
              {"SampledNREPTimes", [&](const xml::Element& child) {
                 Attributes inner{child, problems_};
                 HousekeepingStructure::SampledSet set;
                 set.repetitions = inner.required_integer<std::uint16_t>("nrep", 1, 65'535);
                 if (set.repetitions != 0 && structure.interval_cycles % set.repetitions != 0)
                   problems_.add(*child.find("nrep"), "E0214",
                                 fmt::format("nrep {} does not divide the interval {}", set.repetitions,
                                             structure.interval_cycles));
                 read_sampled(child, set.parameters, user);
                 structure.sampled_repeatedly.push_back(std::move(set));
               }}});
  std::size_t octets = 0;
  for (const auto& reference : structure.sampled_once) octets += octets_of_reference(reference);
  for (const auto& set : structure.sampled_repeatedly)
    for (const auto& reference : set.parameters) octets += set.repetitions * octets_of_reference(reference);
  if (octets > max_housekeeping_octets)
    problems_.add(element, "E0215", fmt::format("{} takes {} octets in one report", user, octets),
                  fmt::format("at most {}", max_housekeeping_octets));
  expect_room(element, structure, services);
  if (element.children.empty())
    problems_.add(element, "E0106", "<HKService> needs <SampledOnce> or <SampledNREPTimes>");
  if (structure.id != 0)
    services.structure_ids.add(std::to_string(structure.id), place(element.find("id")->value_at), problems_,
                               element.find("id")->value.size());
  services.housekeeping.push_back(std::move(structure));
}

/// What CONFIGURE would fail on. A configuration's structures come on top of the subsystem's.
void SubsystemReader::expect_room(const xml::Element& element, const HousekeepingStructure& structure,
                                  const Services& services) {
  const bool of_configuration = &services.housekeeping != &subsystem_.housekeeping;
  const std::size_t before = services.housekeeping.size() + (of_configuration ? subsystem_.housekeeping.size() : 0);
  if (before == most_flown_structures)  // once, not for each that follows
    problems_.add(element, "E0257", fmt::format("more than {} housekeeping structures", most_flown_structures),
                  of_configuration ? "those of the subsystem and of a configuration together; values of one interval "
                                     "find room in one structure"
                                   : "values of one interval find room in one structure");
  const auto too_many = [](const auto& list) { return list.size() > most_listed_values; };
  if (too_many(structure.sampled_once) || too_many(structure.sampled_repeatedly) ||
      std::ranges::any_of(structure.sampled_repeatedly, too_many, &HousekeepingStructure::SampledSet::parameters))
    problems_.add(element, "E0257",
                  fmt::format("HKService {} has a list of more than {}", structure.id, most_listed_values),
                  fmt::format("at most {} <ParamRef> sampled once, {} <SampledNREPTimes>, and {} <ParamRef> in each: "
                              "an array or a structure is one",
                              most_listed_values, most_listed_values, most_listed_values));
  constexpr std::size_t most_octets = max_housekeeping_octets + 2;  // no structure id stands before it
  if (const std::size_t octets = definition_octets_of(structure); octets > most_octets)
    problems_.add(element, "E0257", fmt::format("the definition of HKService {} takes {} octets", structure.id, octets),
                  fmt::format("at most {} fit into TM[3,10]: 9, 3 for each <SampledNREPTimes>, 4 for each <ParamRef>",
                              most_octets));
}

void SubsystemReader::read_sampled(const xml::Element& element, std::vector<ParameterRef>& into,
                                   std::string_view user) {
  each_child(element, problems_, {{"ParamRef", [&](const xml::Element& child) {
                                     Attributes attributes{child, problems_};
                                     no_children(child, problems_);
                                     if (auto reference = read_reference(attributes, user))
                                       into.push_back(std::move(*reference));
                                   }}});
  if (element.children.empty())
    problems_.add(element, "E0106", fmt::format("<{}> needs at least one <ParamRef>", element.name));
}

LinkTerms SubsystemReader::read_terms(Attributes& attributes) {
  LinkTerms terms;
  terms.methods = attributes.list_of<LinkMethod>("methods", terms.methods);
  terms.kinds = attributes.list_of<LinkKind>("kind", terms.kinds);
  expect_built_in<&LinkMechanism::method>(attributes, problems_, "methods");
  expect_built_in<&LinkMechanism::kind>(attributes, problems_, "kind");
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
std::uint32_t SubsystemReader::read_depth(Attributes& attributes, LinkTerms& terms) {
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

CycleLimit SubsystemReader::read_limit(Attributes& attributes, std::string_view realtime, std::string_view reduced,
                                       CycleLimit fallback) {
  CycleLimit limit;
  limit.realtime = attributes.integer_or<std::uint32_t>(realtime, 1, max_cycles, fallback.realtime);
  // A limit that was raised for real time is not to be tighter without it.
  limit.reduced =
      attributes.integer_or<std::uint32_t>(reduced, 1, max_cycles, std::max(fallback.reduced, limit.realtime));
  return limit;
}

void SubsystemReader::read_provides(const xml::Element& element, Services& services) {
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
  read_sampled(element, set.parameters, user);
  Unique names{"field name", "E0201"};
  std::size_t octets = 0, fields = 0;
  for (const ParameterRef& reference : set.parameters) {
    octets += octets_of_reference(reference);
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
void SubsystemReader::read_lent(const xml::Element& element, std::vector<Field>& fields) {
  Unique names{"field name", "E0201"};
  each_child(element, problems_,
             {{"Field", [&](const auto& child) { read_plain_field(child, fields, names, Says::Lent); }, max_set_fields},
              {"ParamRef", [&](const xml::Element& child) {
                 problems_.add(child, "E0231", "a set that is lent has fields of its own, no parameters",
                               "<Field name=\"...\" type=\"...\" count=\"...\"/>, or another kind");
               }}});
  if (fields.empty()) problems_.add(element, "E0106", "<Provides> that is lent needs at least one <Field>");
}

void SubsystemReader::check_lent(const xml::Element& element, std::string_view name, const std::vector<Field>& fields) {
  NaturalLayout layout;
  for (const Field& field : fields) layout.add(field.type, field.count);
  if (layout.octets() > max_loaned_payload_octets)
    problems_.add(element, "E0215", fmt::format("set '{}' takes {} octets in one sample", name, layout.octets()),
                  fmt::format("at most {}", max_loaned_payload_octets));
}

void SubsystemReader::read_requires(const xml::Element& element, Services& services) {
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
             {{"Field", [&](const auto& child) { read_plain_field(child, set.fields, names, says, NameKind::Way); },
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
