// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/in_flight.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/alike.hpp"
#include "hirosco/descriptor/model/differences.hpp"
#include "hirosco/descriptor/model/framework_parameters.hpp"
#include "hirosco/descriptor/model/supervisor_events.hpp"

namespace hirosco::descriptor {
namespace {

constexpr std::string_view content_why =
    "ground and log read the reports of this id by it: another content has another id";
constexpr std::string_view code_why = "the program that runs has it built in, or has not";
constexpr std::string_view timing_why = "guard and links go by it, and that the cycles of the mode end in time";
constexpr std::string_view link_why = "links are made by it, and their other ends read them so";
constexpr std::string_view by_name_why =
    "its other ends read it by name, type and length: what is otherwise stands beside it under another name";
constexpr std::string_view lent_why =
    "a lent sample is one object in the memory of all ends of its links: all their programs at once, in another flight";
constexpr std::string_view guard_why = "the guard holds it from before the start, out of reach of everybody";
constexpr std::string_view limit_why = "pools, limits and the books of resources were made when the process started";
constexpr std::string_view safety_why = "nothing that safety rests on is loosened in flight";
constexpr std::string_view force_why =
    "the configuration in force was made of it: read before CONFIGURE, or in Offline";
constexpr std::string_view stored_why = "what is stored was laid out when the flight began";
constexpr std::string_view foreign_why = "whom it hears was made known to it and to others when the flight began";
constexpr std::string_view bound_why =
    "no mode and no state would bind it, and it would not wait for the log: the flight has what it began with";
constexpr std::string_view told_why = "the supervisor tells of that by this name, and plans would be chosen otherwise";
constexpr std::string_view behind_why = "what is new stands behind what was there, whose place is kept";

using differences::addition_why;
using differences::Differences;
using differences::is_listed;
using differences::its_name;
using differences::its_place;
using differences::layout_why;
using differences::meaning_why;
using differences::no_place;

using alike::same_address;
using alike::same_held;
using alike::same_limit;
using alike::same_outputs;
using alike::same_structures;
using alike::same_use;

constexpr auto parameter_name = [](const Parameter& each) { return each.field.name; };

[[nodiscard]] bool same_texts(const std::vector<EnumerationText>& a, const std::vector<EnumerationText>& b) {
  return std::ranges::equal(
      a, b, [](const EnumerationText& x, const EnumerationText& y) { return x.value == y.value && x.text == y.text; });
}
[[nodiscard]] bool same_end(const std::optional<Endnode>& a, const std::optional<Endnode>& b) {
  return a.has_value() == b.has_value() && (!a || same_address(*a, *b));
}
[[nodiscard]] bool same_terms(const LinkTerms& a, const LinkTerms& b) {
  return a.methods == b.methods && a.byte_orders == b.byte_orders && a.kinds == b.kinds;
}
[[nodiscard]] bool same_use_of_service(const ServiceUse& a, const ServiceUse& b) {
  return a.type == b.type && a.offered == b.offered && a.loop == b.loop;
}
[[nodiscard]] bool same_bumpless(const Bumpless& a, const Bumpless& b) {
  return a.configurations == b.configurations &&
         std::ranges::equal(a.steps, b.steps, [](const Bumpless::Step& x, const Bumpless::Step& y) {
           return x.device == y.device && x.output == y.output && x.most == y.most;
         });
}
/// But for its queues, which are as long as what it says takes.
[[nodiscard]] bool same_budget(const Resources& a, const Resources& b) {
  return a.most == b.most && a.waiting == b.waiting && a.channel_kb == b.channel_kb &&
         a.warning_percent == b.warning_percent &&
         std::ranges::equal(a.pools, b.pools, [](const Pool& x, const Pool& y) {
           return x.block_octets == y.block_octets && x.blocks == y.blocks;
         });
}
[[nodiscard]] bool same_loop(const ServiceLoop& a, const ServiceLoop& b) {
  return a.period == b.period && a.priority == b.priority && a.budget == b.budget && a.queue == b.queue;
}
[[nodiscard]] bool same_pace(const ServiceLoop& a, const ServiceLoop& b) { return a.name == b.name && same_loop(a, b); }
[[nodiscard]] bool same_script(const ScriptFile& a, const ScriptFile& b) {
  return a.name == b.name && a.file == b.file;
}
[[nodiscard]] bool same_things(const std::vector<Thing>& a, const std::vector<Thing>& b) {
  return std::ranges::equal(a, b, [](const Thing& x, const Thing& y) { return x.kind == y.kind && x.name == y.name; });
}

[[nodiscard]] bool same_parts(const std::vector<Parameter::Part>& flown, const std::vector<Parameter::Part>& fresh) {
  return std::ranges::equal(flown, fresh, [](const Parameter::Part& a, const Parameter::Part& b) {
    [[maybe_unused]] const auto& [name, id, first, count, at] = b;
    return a.name == name && a.id == id && a.first == first && a.count == count;
  });
}

/// Places, each in its own descriptor: what is added moves others in the list, not in meaning.
[[nodiscard]] bool same_places(const SubsystemDescriptor& flown, const std::vector<ParameterRef>& those,
                               const SubsystemDescriptor& fresh, const std::vector<ParameterRef>& these) {
  return std::ranges::equal(those, these, [&](const ParameterRef& a, const ParameterRef& b) {
    return a.member == b.member &&
           flown.parameters.at(a.parameter).field.name == fresh.parameters.at(b.parameter).field.name;
  });
}
/// What a set takes of parameters, by name and place alone.
[[nodiscard]] std::vector<Field> places_in(const SubsystemDescriptor& subsystem, const Provides& set) {
  std::vector<Field> places;
  for (const ParameterRef& each : set.parameters) {
    const Parameter& parameter = subsystem.parameters.at(each.parameter);
    Field& place = places.emplace_back();
    place.name = parameter.field.name;
    const std::size_t members = parameter.members.size();
    if (each.member)
      place.name += "." + (*each.member < members ? parameter.members[*each.member].field.name
                                                  : parameter.parts.at(*each.member - members).name);
    place.at = set.at;
  }
  return places;
}

[[nodiscard]] bool same_report(const SubsystemDescriptor& flown, const HousekeepingStructure& before,
                               const SubsystemDescriptor& fresh, const HousekeepingStructure& now) {
  using Sampled = HousekeepingStructure::SampledSet;
  return same_places(flown, before.sampled_once, fresh, now.sampled_once) &&
         std::ranges::equal(before.sampled_repeatedly, now.sampled_repeatedly, [&](const Sampled& a, const Sampled& b) {
           return a.repetitions == b.repetitions && same_places(flown, a.parameters, fresh, b.parameters);
         });
}

/// Of those that another process is to have: what was made of the others by their places in the list stays true.
void judge_new_parameters(const SubsystemDescriptor& flown, const SubsystemDescriptor& fresh,
                          std::vector<Obstacle>& found) {
  const auto built_in = built_in_parameters(fresh);
  bool something_behind = false;
  for (auto each = fresh.parameters.rbegin(); each != fresh.parameters.rend(); ++each) {
    const std::string& name = each->field.name;
    if (is_listed(flown.parameters, name, parameter_name)) {
      something_behind = something_behind || std::ranges::find(built_in, name) == built_in.end();
      continue;
    }
    const auto unless = [&](bool good, const char* what, std::string_view why) {
      if (!good) found.push_back({each->field.at, "parameter " + name + " is new and " + what + ": that", why});
    };
    unless(!each->persistent, "is to outlive the flight", stored_why);
    unless(each->from.empty(), "has the value of another subsystem's", foreign_why);
    unless(!something_behind, "stands before others", behind_why);
  }
}

/// What passes every mode, and by what name plans are chosen, is as it was when the flight began.
void judge_new_names(const SubsystemDescriptor& flown, const SubsystemDescriptor& fresh, std::vector<Obstacle>& found) {
  for (const Function& each : fresh.functions)
    if (each.essential && !is_listed(flown.functions, each.name, its_name))
      found.push_back({each.at, "function " + each.name + " is new and essential: that", bound_why});
  for (const Event& each : fresh.events)
    if (is_about_subsystem(each.name) && !is_listed(flown.events, each.name, its_name))
      found.push_back({each.at, "event " + each.name + " is new: that", told_why});
}

/// Each struct is taken apart by all of its members: one that is added has to be decided on here.
class Comparison : Differences {
 public:
  Comparison(const SubsystemDescriptor& flown, const SubsystemDescriptor& fresh, TakenBy by)
      : Differences{by}, flown_{flown}, fresh_{fresh} {}
  using Differences::take;

  void arguments(const std::vector<Function::Argument>& flown, const std::vector<Function::Argument>& fresh,
                 const std::string& what) {
    lists(
        flown, fresh, what + ": argument ", [](const Function::Argument& each) { return each.field.name; },
        [](const Function::Argument& each) { return each.field.at; }, code_why,
        [&](const auto& a, const auto& b) {
          [[maybe_unused]] const auto& [value, of, fallback, texts] = b;
          const std::string its = what + ": argument " + value.name;
          field(a.field, value, its);
          unless(a.of == of, value.at, its + ": whose value it is", code_why);
          unless(!a.fallback == !fallback, value.at, its + ": whether it may be left out", code_why);
          unless(same_texts(a.texts, texts), value.at, its + ": its values and their names", meaning_why);
        });
  }
  void function(const Function& flown, const Function& fresh, const std::string& kind) {
    [[maybe_unused]] const auto& [name, service, subtype, states, essential, confirm, args, text, at, sets,
                                  unrepeated] = fresh;
    const std::string what = kind + name;
    unless(flown.service == service && flown.subtype == subtype, at, what + ": its type", code_why);
    unless(flown.states == states && flown.essential == essential, at, what + ": when it is permitted", safety_why);
    unless(flown.unrepeated == unrepeated, at, what + ": which parameters it sets", safety_why);
    arguments(flown.arguments, args, what);
  }
  void functions(const std::vector<Function>& flown, const std::vector<Function>& fresh, const std::string& kind) {
    lists(flown, fresh, kind, its_name, its_place, code_why,
          [&](const Function& a, const Function& b) { function(a, b, kind); });
  }
  void parameter(const Parameter& flown, const Parameter& fresh) {
    [[maybe_unused]] const auto& [value, id, init, writable_states, protection, persistent, members, parts, from, age] =
        fresh;
    const std::string what = "parameter " + value.name;
    field(flown.field, value, what);
    unless(flown.id == id, value.at, what + ": its id", layout_why);
    unless(flown.protection == protection, value.at, what + ": whether it protects", safety_why);
    const bool same_range = flown.field.minimum == value.minimum && flown.field.maximum == value.maximum;
    unless(!protection || (same_range && flown.init == init), value.at,
           what + ": range or initial value of a protection", safety_why);
    unless(flown.persistent == persistent, value.at, what + ": whether it outlives the flight", layout_why);
    lists(
        flown.members, members, what + ": member ", [](const Parameter::Member& each) { return each.field.name; },
        [](const Parameter::Member& each) { return each.field.at; }, layout_why,
        [&](const Parameter::Member& a, const Parameter::Member& b) {
          [[maybe_unused]] const auto& [member, member_id] = b;
          field(a.field, member, what + "." + member.name);
          unless(a.id == member_id, member.at, what + "." + member.name + ": its id", layout_why);
        });
    unless(same_parts(flown.parts, parts), value.at, what + ": the structures within", layout_why);
    unless(flown.from == from && flown.age == age, value.at, what + ": whose value it has", code_why);
  }
  void parameters() {
    growing(
        flown_.parameters, fresh_.parameters, "parameter ", parameter_name,
        [](const Parameter& each) { return each.field.at; }, layout_why,
        [&](const Parameter& a, const Parameter& b) { parameter(a, b); });
    if (by_ == TakenBy::AnotherProcess) judge_new_parameters(flown_, fresh_, found_);
  }
  /// One may come, go, be switched or have another interval; what it reports stays with its id.
  void structures(const std::vector<HousekeepingStructure>& flown, const std::vector<HousekeepingStructure>& fresh,
                  const std::string& what) {
    for (const HousekeepingStructure& each : fresh) {
      const auto before = std::ranges::find(flown, each.id, &HousekeepingStructure::id);
      if (before == flown.end()) continue;
      unless(same_report(flown_, *before, fresh_, each), each.at,
             what + " " + std::to_string(each.id) + ": what it reports", content_why);
    }
  }
  void event(const Event& flown, const Event& fresh) {
    [[maybe_unused]] const auto& [name, id, severity, arguments_, at, safety] = fresh;
    const std::string what = "event " + name;
    unless(flown.id == id, at, what + ": its id", code_why);
    unless(flown.severity == severity && flown.safety == safety, at, what + ": what follows it", safety_why);
    fields(flown.arguments, arguments_, what, code_why);
  }
  void service(const CustomService& flown, const CustomService& fresh) {
    [[maybe_unused]] const auto& [name, type, requests, reports, at] = fresh;
    const std::string what = "service " + name;
    unless(flown.type == type, at, what + ": its type", code_why);
    functions(flown.requests, requests, what + ": request ");
    lists(
        flown.reports, reports, what + ": report ", its_name, [&](const CustomService::Report&) { return fresh.at; },
        code_why,
        [&](const CustomService::Report& a, const CustomService::Report& b) {
          unless(a.subtype == b.subtype, at, what + ": report " + b.name + ": its subtype", code_why);
          arguments(a.fields, b.fields, what + ": report " + b.name);
        });
  }
  void device(const Device& flown, const Device& fresh) {
    [[maybe_unused]] const auto& [name, part_of, actuator, input, output, stop, stop_within, enable, at, enable_terms] =
        fresh;
    const std::string what = "device " + name;
    unless(flown.part_of == part_of && flown.actuator == actuator, at, what + ": what it is", code_why);
    unless(flown.stop == stop && flown.stop_within == stop_within, at, what + ": how it stops", guard_why);
    unless(same_end(flown.enable, enable) && same_held(flown.enable_terms, enable_terms), at,
           what + ": its second inhibit", guard_why);
    fields(flown.input, input, what, layout_why);
    lists(
        flown.output, output, what + ": field ", [](const Device::Output& each) { return each.field.name; },
        [](const Device::Output& each) { return each.field.at; }, layout_why,
        [&](const Device::Output& a, const Device::Output& b) {
          field(a.field, b.field, what + ": field " + b.field.name);
          const bool same =
              a.safe == b.safe && a.field.minimum == b.field.minimum && a.field.maximum == b.field.maximum;
          unless(!actuator || same, b.field.at, what + ": what an actuator may be told", safety_why);
        });
  }
  void required(const Requires& flown, const Requires& fresh, const std::string& whose) {
    [[maybe_unused]] const auto& [name, from, terms, depth, required_, starts, age, missing, fields_, at] = fresh;
    const std::string what = whose + ": required set " + name;
    unless(flown.from == from && same_terms(flown.terms, terms) && flown.depth == depth, at, what + ": its terms",
           link_why);
    unless(flown.required == required_ && flown.missing == missing, at, what + ": what is without it", safety_why);
    if (terms.lent()) return fields(flown.fields, fields_, what, lent_why);
    growing(flown.fields, fields_, what + ": field ", its_name, its_place, link_why,
            [&](const Field& a, const Field& b) { carried(a, b, what + ": field " + b.name); });
  }
  /// Of a set that is read by name.
  void carried(const Field& flown, const Field& fresh, const std::string& what) {
    const bool same = flown.type == fresh.type && flown.count == fresh.count && flown.text == fresh.text &&
                      flown.text_octets == fresh.text_octets;
    unless(same, fresh.at, what + ": its type or length", by_name_why);
    if (same) field(flown, fresh, what);
  }
  void provided(const Provides& flown, const Provides& fresh, const std::string& whose) {
    [[maybe_unused]] const auto& [name, terms, parameters_, fields_, at] = fresh;
    const std::string what = whose + ": provided set " + name;
    unless(same_terms(flown.terms, terms), at, what + ": its terms", link_why);
    if (terms.lent()) return fields(flown.fields, fields_, what, lent_why);
    growing(places_in(flown_, flown), places_in(fresh_, fresh), what + ": field ", its_name, its_place, link_why,
            [](const Field&, const Field&) {});
  }
  void use(const DeviceUse& flown, const DeviceUse& fresh, const std::string& whose) {
    [[maybe_unused]] const auto& [device_, silence, every, watchdog_us, watchdog_reduced_us, settings, endnode,
                                  fall_backs, at] = fresh;
    const std::string what = whose + ": device " + fresh_.devices[device_].name;
    unless(flown.device == device_, at, what + ": which it is", code_why);
    unless(flown.endnode.byte_order == endnode.byte_order, at, what + ": its byte order", layout_why);
    unless(std::ranges::equal(flown.settings, settings, {}, &Setting::name, &Setting::name), at,
           what + ": which settings it has", code_why);
    unless(!fresh_.devices[device_].actuator ||
               (flown.watchdog_us == watchdog_us && flown.watchdog_reduced_us == watchdog_reduced_us),
           at, what + ": the watchdog of an actuator", safety_why);
    unless(flown.fall_backs.empty() == fall_backs.empty(), at, what + ": whether it has fall-backs", code_why);
  }
  void configuration(const Configuration& flown, const Configuration& fresh) {
    [[maybe_unused]] const auto& [name, id, priority, sampling, started_by, least, budget, spin, power_w, overruns,
                                  self_test, self_test_within, housekeeping, provides, requires_, devices, initial,
                                  services, paces, at] = fresh;
    const std::string what = "configuration " + name;
    unless(flown.id == id, at, what + ": its id", code_why);
    unless(flown.priority == priority && flown.sampling == sampling && flown.budget == budget, at,
           what + ": priority, sampling time or budget", timing_why);
    unless(flown.started_by == started_by && flown.least == least, at, what + ": what starts its cycles", timing_why);
    unless(flown.spin == spin, at, what + ": how long before its cycles it wakes", timing_why);
    unless(std::ranges::equal(flown.services, services, same_use_of_service), at, what + ": which services it has",
           code_why);
    unless(std::ranges::equal(flown.paces, paces, same_pace), at, what + ": how its loops of services go", timing_why);
    unless(flown.self_test == self_test, at, what + ": whether it wants a self test", safety_why);
    structures(flown.housekeeping, housekeeping, what + ": housekeeping");
    lists(
        flown.provides, provides, what + ": provided set ", its_name, [](const Provides& each) { return each.at; },
        link_why, [&](const Provides& a, const Provides& b) { provided(a, b, what); });
    lists(
        flown.requires_, requires_, what + ": required set ", its_name, [](const Requires& each) { return each.at; },
        link_why, [&](const Requires& a, const Requires& b) { required(a, b, what); });
    lists(
        flown.devices, devices, what + ": device ",
        [&](const DeviceUse& each) {
          return each.device < fresh_.devices.size() ? fresh_.devices[each.device].name : std::string{};
        },
        [](const DeviceUse& each) { return each.at; }, code_why,
        [&](const DeviceUse& a, const DeviceUse& b) { use(a, b, what); });
  }
  void subsystem() {
    const SubsystemDescriptor& flown = flown_;
    [[maybe_unused]] const auto& [name, id, description, file, text, enumerations, parameters_, events, functions_,
                                  services, failures, commands, subscribes, housekeeping, devices, power_switches,
                                  configurations, hang, resources, loops, uses, bumpless, scripts] = fresh_;
    unless(flown.name == name && flown.id == id, {}, "its name or id", code_why);
    growing(flown.enumerations, enumerations, "enumeration ", its_name, no_place, meaning_why,
            [&](const Enumeration& a, const Enumeration& b) {
              unless(same_texts(a.texts, b.texts), {}, "enumeration " + b.name + ": its values and their names",
                     meaning_why);
            });
    parameters();
    growing(flown.events, events, "event ", its_name, its_place, code_why,
            [&](const Event& a, const Event& b) { event(a, b); });
    growing(flown.functions, functions_, "function ", its_name, its_place, code_why,
            [&](const Function& a, const Function& b) { function(a, b, "function "); });
    lists(
        flown.services, services, "service ", its_name, [](const CustomService& each) { return each.at; }, code_why,
        [&](const CustomService& a, const CustomService& b) { service(a, b); });
    kept(flown.failures, failures, "failure ", its_name, no_place, meaning_why,
         [&](const FailureName& a, const FailureName& b) {
           unless(a.code == b.code, {}, "failure " + b.name + ": its code", meaning_why);
         });
    structures(flown.housekeeping, housekeeping, "housekeeping");
    lists(
        flown.commands, commands, "command of ", [](const Commands& each) { return each.subsystem; },
        [](const Commands& each) { return each.at; }, code_why,
        [&](const Commands& a, const Commands& b) {
          unless(a.functions == b.functions && same_things(a.things, b.things), b.at,
                 "what it commands " + b.subsystem + " for", code_why);
        });
    lists(
        flown.subscribes, subscribes, "what it hears of ", [](const Subscribes& each) { return each.subsystem; },
        [](const Subscribes& each) { return each.at; }, code_why,
        [&](const Subscribes& a, const Subscribes& b) {
          unless(same_things(a.things, b.things), b.at, "what it hears of " + b.subsystem, code_why);
        });
    lists(flown.service_loops, loops, "loop of services ", its_name, its_place, timing_why,
          [&](const ServiceLoop& a, const ServiceLoop& b) {
            unless(same_loop(a, b), b.at, "loop of services " + b.name, timing_why);
          });
    unless(std::ranges::equal(flown.scripts, scripts, same_script), {}, "which scripts it has", code_why);
    unless(std::ranges::equal(flown.service_uses, uses, same_use_of_service), {}, "which services it has", code_why);
    unless(std::ranges::equal(flown.bumpless, bumpless, same_bumpless), {},
           "which configurations follow each other without a break", safety_why);
    lists(
        flown.devices, devices, "device ", its_name, [](const Device& each) { return each.at; }, code_why,
        [&](const Device& a, const Device& b) { device(a, b); });
    lists(
        flown.power_switches, power_switches, "power switch of ", [](const PowerSwitch& each) { return each.device; },
        [](const PowerSwitch& each) { return each.at; }, guard_why,
        [&](const PowerSwitch& a, const PowerSwitch& b) {
          unless(same_end(a.endnode, b.endnode) && same_held(a.terms, b.terms), b.at,
                 "power switch of " + b.device + ": its endnode", guard_why);
        });
    if (found_.empty())  // its devices are known by number
      lists(
          flown.configurations, configurations, "configuration ", its_name,
          [](const Configuration& each) { return each.at; }, code_why,
          [&](const Configuration& a, const Configuration& b) { configuration(a, b); });
    unless(flown.hang.realtime == hang.realtime && flown.hang.reduced == hang.reduced, {}, "when it counts as hanging",
           guard_why);
    const bool same_queues = by_ == TakenBy::AnotherProcess || flown.resources.queues == resources.queues;
    unless(same_budget(flown.resources, resources) && same_queues, {}, "its resources", limit_why);
  }

 private:
  const SubsystemDescriptor& flown_;
  const SubsystemDescriptor& fresh_;
};

}  // namespace

const char* const not_in_flight = "E0380";

std::vector<Obstacle> obstacles(const SubsystemDescriptor& flown, const SubsystemDescriptor& fresh, TakenBy by) {
  Comparison comparison{flown, fresh, by};
  comparison.subsystem();
  auto found = comparison.take();
  judge_new_names(flown, fresh, found);
  return found;
}

std::vector<Obstacle> obstacles_in_force(const SubsystemDescriptor& flown, const SubsystemDescriptor& fresh,
                                         std::uint8_t id) {
  std::vector<Obstacle> found;
  const Configuration* now = flown.find_configuration(id);
  const Configuration* then = fresh.find_configuration(id);
  if (now == nullptr || then == nullptr) return found;
  const std::string what = "configuration " + now->name;
  const auto unless = [&](bool same, Location at, const std::string& which) {
    if (!same) found.push_back({at, what + ": " + which, force_why});
  };
  unless(same_structures(flown.housekeeping, fresh.housekeeping), then->at, "housekeeping of the subsystem");
  unless(same_structures(now->housekeeping, then->housekeeping), then->at, "its housekeeping");
  unless(same_limit(now->overruns, then->overruns) && now->self_test_within == then->self_test_within &&
             now->power_w == then->power_w,
         then->at, "its limits or power");
  for (std::size_t i = 0; i < now->requires_.size() && i < then->requires_.size(); ++i)
    unless(same_limit(now->requires_[i].age, then->requires_[i].age), then->requires_[i].at,
           "required set " + then->requires_[i].name + ": its age");
  for (std::size_t i = 0; i < now->devices.size() && i < then->devices.size(); ++i) {
    const DeviceUse &a = now->devices[i], &b = then->devices[i];
    const Device &had = flown.devices[a.device], &has = fresh.devices[b.device];
    unless(same_use(a, b), b.at, "device " + has.name + ": its endnodes, limits or settings");
    unless(same_outputs(had, has), has.at, "device " + has.name + ": what it may be told");
  }
  return found;
}

}  // namespace hirosco::descriptor
