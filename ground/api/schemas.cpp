// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <initializer_list>
#include <string>
#include <utility>

#include "ground/api/openapi.hpp"
#include "ground/model/json.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

enum class May : std::uint8_t { BeAbsent };

/// A field of an object: always there, unless it may be absent.
struct Property {
  Property(const char* its_name, json its_schema) : name{its_name}, schema(std::move(its_schema)) {}
  Property(const char* its_name, json its_schema, May) : Property{its_name, std::move(its_schema)} { required = false; }
  const char* name;
  json schema;
  bool required{true};
};

[[nodiscard]] json object(std::initializer_list<Property> properties) {
  json schema;
  schema["type"] = "object";
  for (const Property& property : properties) {
    schema["properties"][property.name] = property.schema;
    if (property.required) schema["required"].push_back(property.name);
  }
  return schema;
}

[[nodiscard]] json list_of(json items) {
  json schema;
  schema["type"] = "array";
  schema["items"] = std::move(items);
  return schema;
}

/// Fields of any name.
[[nodiscard]] json map_of(json values) {
  json schema;
  schema["type"] = "object";
  schema["additionalProperties"] = std::move(values);
  return schema;
}

[[nodiscard]] json nullable(json schema) {
  schema["nullable"] = true;
  return schema;
}

[[nodiscard]] json described(json schema, const char* text) {
  schema["description"] = text;
  return schema;
}

[[nodiscard]] json one_of(std::initializer_list<const char*> texts) {
  json schema;
  schema["type"] = "string";
  for (const char* text : texts) schema["enum"].push_back(text);
  return schema;
}

[[nodiscard]] json refers(const char* name) { return {{"$ref", std::string{"#/components/schemas/"} + name}}; }

[[nodiscard]] json primitive(const char* type) { return {{"type", type}}; }

/// The basic kinds, made once.
struct Basic {
  json text = primitive("string");
  json whole = primitive("integer");
  json real = primitive("number");
  json yes_or_no = primitive("boolean");
  json anything = json::object();
  json time = described(primitive("number"), "seconds of on-board time");
  /// As json_number() writes it.
  json number = {{"oneOf", json::array({primitive("number"), one_of({"NaN", "Infinity", "-Infinity"})})}};
  /// As value_json() writes it: a number, a switch, or the words of a text.
  json value = {{"anyOf", json::array({primitive("number"), primitive("boolean"), primitive("string")})}};
  /// As json_value() writes it: whole numbers beyond 2^53 are a text of all their digits.
  json exact = {{"oneOf", json::array({primitive("number"), primitive("string")})}};
  json severity = one_of({"info", "low", "medium", "high"});
  json stage = one_of({"sent", "accepted", "started", "progress", "completed", "failed"});
  json texts = list_of(text);
  json texts_of_values = list_of(object({{"value", exact}, {"name", text}}));
};

void add_mission(const Basic& is, json& into) {
  into["Field"] = object({{"name", is.text},
                          {"type", is.text},
                          {"count", is.whole, May::BeAbsent},
                          {"octets", described(is.whole, "of TEXT: most of them in UTF-8"), May::BeAbsent},
                          {"unit", is.text},
                          {"min", is.exact, May::BeAbsent},
                          {"max", is.exact, May::BeAbsent},
                          {"default", is.exact, May::BeAbsent},
                          {"enumeration", is.texts_of_values, May::BeAbsent}});
  const json fields = list_of(refers("Field"));
  into["Function"] = object({{"name", is.text},
                             {"description", is.text},
                             {"service", is.whole},
                             {"subtype", is.whole},
                             {"essential", is.yes_or_no},
                             {"confirm", described(is.yes_or_no, "sent only with confirmed: true")},
                             {"states", is.texts},
                             {"arguments", fields}});
  into["Subsystem"] = object(
      {{"id", is.whole},
       {"name", is.text},
       {"description", is.text},
       {"configurations", list_of(object({{"id", is.whole}, {"name", is.text}, {"sampling_hz", is.real}}))},
       {"functions", list_of(refers("Function"))},
       {"housekeeping",
        list_of(object({{"sid", is.whole}, {"period_s", is.real}, {"configuration", is.whole}, {"columns", fields}}))},
       {"events",
        list_of(object({{"id", is.whole}, {"name", is.text}, {"severity", is.severity}, {"arguments", fields}}))},
       {"states", is.texts}});
  into["Link"] = object({{"id", is.whole},
                         {"from", is.text},
                         {"provides", is.text},
                         {"to", is.text},
                         {"requires", is.text},
                         {"required", is.yes_or_no},
                         {"rate_hz", nullable(is.real)},
                         {"age_limit_cycles", nullable(is.whole)},
                         {"age_limit_cycles_reduced", is.whole, May::BeAbsent}});
  into["Mode"] = object(
      {{"id", is.whole},
       {"name", is.text},
       {"permits", list_of(object({{"subsystem", is.text}, {"functions", is.texts}, {"services", list_of(is.whole)}}))},
       {"commission", list_of(object({{"subsystem", is.text}, {"configuration", is.text}, {"state", is.text}}))},
       {"establish", list_of(is.whole)}});
  into["Device"] = object({{"name", is.text},
                           {"subsystem", is.text},
                           {"device", is.text},
                           {"faults", list_of(object({{"line", is.text}, {"text", is.text}}))}});
  into["Mission"] =
      object({{"name", is.text},
              {"simulated", is.yes_or_no},
              {"epoch_unix_s", described(is.whole, "added to an on-board time it makes UNIX time")},
              {"start_mode", is.text},
              {"subsystems", list_of(refers("Subsystem"))},
              {"links", list_of(refers("Link"))},
              {"modes", list_of(refers("Mode"))},
              {"devices", list_of(refers("Device"))},
              {"transitions",
               list_of(object({{"from", is.text}, {"to", is.text}, {"kind", one_of({"commanded", "failure"})}}))}});
}

void add_status(const Basic& is, json& into) {
  const json count = nullable(is.whole);
  into["SubsystemStatus"] = object({{"id", is.whole},
                                    {"name", is.text},
                                    {"state", nullable(is.text)},
                                    {"configuration", nullable(is.text)},
                                    {"cycles", count},
                                    {"overruns", count},
                                    {"missed", count},
                                    {"latency_max_ns", count},
                                    {"execution_mean_ns", count},
                                    {"memory_kb", count},
                                    {"inhibited", is.texts},
                                    {"waits_for", is.text},
                                    {"age_s", nullable(is.real)}});
  into["LinkStatus"] =
      object({{"id", is.whole},
              {"up", nullable(is.yes_or_no)},
              {"age_cycles", nullable(is.real)},
              {"rate_hz", nullable(is.real)},
              {"samples", count},
              {"lost", count},
              {"latency_mean_ns", nullable(is.real)},
              {"latency_max_ns", nullable(is.real)},
              {"jitter_ns", nullable(is.real)},
              {"age_at_use_us", nullable(is.real)},
              {"latencies", nullable(object({{"period_ns", is.real}, {"counts", list_of(is.whole)}}))}});
  into["GroundLinkStatus"] = object({{"connected", is.yes_or_no},
                                     {"age_s", nullable(is.real)},
                                     {"rx", is.whole},
                                     {"tx", is.whole},
                                     {"lost", is.whole},
                                     {"damaged", is.whole},
                                     {"archive_failures", is.whole}});
  into["Status"] = object({{"t", is.time},
                           {"mode", nullable(is.text)},
                           {"commandable", is.yes_or_no},
                           {"link", refers("GroundLinkStatus")},
                           {"subsystems", list_of(refers("SubsystemStatus"))},
                           {"links", list_of(refers("LinkStatus"))},
                           {"values", map_of(object({{"v", is.value}, {"t", is.time}, {"age_s", is.real}}))}});
}

void add_past(const Basic& is, json& into) {
  const json code = nullable(is.whole), reason = nullable(is.text);
  const json fault = object({{"t", is.time}, {"device", is.text}, {"line", is.text}, {"answer", is.text}});
  into["Event"] = object({{"t", is.time},
                          {"apid", is.whole},
                          {"subsystem", is.text},
                          {"id", is.whole},
                          {"name", is.text},
                          {"severity", is.severity},
                          {"text", is.text},
                          {"values", map_of(is.anything)}});
  into["Report"] = object({{"t", is.time}, {"stage", is.stage}, {"code", code}, {"reason", reason}});
  into["Command"] = object({{"id", is.whole},
                            {"t", is.time},
                            {"sender", is.text},
                            {"apid", is.whole},
                            {"subsystem", is.text},
                            {"function", is.text},
                            {"arguments", map_of(is.anything)},
                            {"stage", is.stage},
                            {"code", code},
                            {"reason", reason},
                            {"reports", described(list_of(refers("Report")), "in /api/commands"), May::BeAbsent}});
  into["Gap"] = object({{"from", is.time}, {"to", is.time}});
  into["Events"] = object({{"events", list_of(refers("Event"))}});
  into["Commands"] = object({{"commands", list_of(refers("Command"))}});
  into["Timeline"] =
      object({{"modes", list_of(object({{"t", is.time}, {"mode", is.text}}))},
              {"states", list_of(object({{"t", is.time}, {"subsystem", is.text}, {"state", nullable(is.text)}}))},
              {"links", list_of(object({{"t", is.time}, {"id", is.whole}, {"up", is.yes_or_no}}))},
              {"commands", list_of(refers("Command"))},
              {"events", list_of(refers("Event"))},
              {"faults", list_of(fault)},
              {"gaps", list_of(refers("Gap"))}});
  const json numbers = list_of(is.number);
  into["History"] =
      object({{"parameter", is.text},
              {"unit", is.text},
              {"t", list_of(is.time)},
              {"v", numbers, May::BeAbsent},
              {"min", described(numbers, "of buckets, instead of v"), May::BeAbsent},
              {"max", numbers, May::BeAbsent},
              {"gaps", list_of(refers("Gap"))},
              {"complete", described(is.yes_or_no, "false: more than 1,000,000 samples, the newest are missing")}});
  into["Log"] = object({{"packets", list_of(object({{"number", is.whole},
                                                    {"t", is.time},
                                                    {"apid", is.whole},
                                                    {"subsystem", is.text},
                                                    {"service", is.whole},
                                                    {"subtype", is.whole},
                                                    {"text", is.text}}))},
                        {"before", described(nullable(is.whole), "where to go on; null: nothing is older")}});
}

void add_people(const Basic& is, json& into) {
  const json act = nullable(object({{"t", is.time},
                                    {"who", is.text},
                                    {"note", is.text},
                                    {"until", described(is.time, "of a shelf"), May::BeAbsent}}));
  into["Alarm"] = object({{"t", described(is.time, "of the newest")},
                          {"first", is.time},
                          {"apid", is.whole},
                          {"subsystem", is.text},
                          {"id", is.whole},
                          {"name", is.text},
                          {"severity", is.severity},
                          {"text", is.text},
                          {"values", map_of(is.anything)},
                          {"count", described(is.whole, "how often in this flight")},
                          {"fresh", described(is.whole, "of these since the last acknowledgement")},
                          {"calls", described(is.yes_or_no, "fresh, and not shelved")},
                          {"acknowledged", act},
                          {"shelved", act}});
  into["Alarms"] =
      object({{"alarms", described(list_of(refers("Alarm")), "those that call first")},
              {"seen_until", described(nullable(is.time), "when somebody acknowledged all, the last stop too")}});
  into["AlarmRequest"] = object({{"subsystem", described(is.text, "its name; * acknowledges all")},
                                 {"event", described(is.text, "its name"), May::BeAbsent},
                                 {"action", one_of({"acknowledge", "shelve", "unshelve"})},
                                 {"for_s", described(is.real, "of shelve: 1 to 86400"), May::BeAbsent},
                                 {"note", described(is.text, "at most 200 characters"), May::BeAbsent},
                                 {"sender", is.text, May::BeAbsent}});
  into["Authority"] = object(
      {{"holder", nullable(object({{"seat", is.text}, {"name", is.text}, {"since", is.time}}))},
       {"asking",
        nullable(object({{"seat", is.text},
                         {"name", is.text},
                         {"answer_s", described(is.real, "until it goes over when the holder says nothing")}}))}});
  into["AuthorityRequest"] = object({{"action", one_of({"take", "keep", "hand_over"})},
                                     {"seat", described(is.text, "1 to 64 characters that nobody else has")},
                                     {"sender", is.text, May::BeAbsent}});
  const json notes = list_of(object({{"t", is.time}, {"who", is.text}, {"text", is.text}}));
  into["Present"] =
      object({{"pages", list_of(object({{"client", is.text},
                                        {"seat", is.text},
                                        {"name", described(is.text, "as the page says; \"\": it says none")},
                                        {"operator", is.yes_or_no},
                                        {"replay", described(is.yes_or_no, "it looks at the past")}}))},
              {"operators", described(is.whole, "pages that may command, of all")},
              {"observers", is.whole}});
  into["Flights"] = object({{"flights", list_of(object({{"id", is.whole},
                                                        {"from", is.time},
                                                        {"to", is.time},
                                                        {"name", is.text},
                                                        {"named_by", is.text},
                                                        {"notes", notes},
                                                        {"high", described(is.whole, "events of this severity")},
                                                        {"medium", is.whole},
                                                        {"commands", is.whole}}))}});
  into["FlightRequest"] = object({{"flight", described(is.whole, "its id")},
                                  {"name", described(is.text, "at most 80 characters; without a note"), May::BeAbsent},
                                  {"note", described(is.text, "1 to 1,000 octets: one more"), May::BeAbsent},
                                  {"sender", is.text, May::BeAbsent}});
  into["FlightName"] =
      object({{"flight", is.whole}, {"name", is.text, May::BeAbsent}, {"notes", notes, May::BeAbsent}});
  into["Stacks"] = object({{"stacks", list_of(object({{"name", is.text},
                                                      {"text", described(is.text, "lines of hirosco tc")},
                                                      {"t", described(is.time, "when it was kept")},
                                                      {"who", is.text}}))}});
  into["StackRequest"] =
      object({{"name", described(is.text, "1 to 80 octets")},
              {"text", described(is.text, "at most 20,000 octets; none: it is forgotten"), May::BeAbsent},
              {"sender", is.text, May::BeAbsent}});
  into["Marks"] = object({{"marks", list_of(object({{"t", is.time},
                                                    {"kind", one_of({"alarm", "authority", "flight", "stack"})},
                                                    {"name", is.text},
                                                    {"action", is.text},
                                                    {"who", is.text},
                                                    {"note", is.text},
                                                    {"until", nullable(is.time)}}))}});
}

void add_story(const Basic& is, json& into) {
  const json cause = object(
      {{"t", is.time},
       {"after_ms", described(nullable(is.real), "from the first event of weight; null: before it, when is not known")},
       {"severity", is.severity},
       {"text", is.text}});
  into["Story"] = object(
      {{"t", is.time, May::BeAbsent},
       {"title", described(is.text, "the cause, and who was stopped"), May::BeAbsent},
       {"detail", described(is.text, "who went where within what time, by which plan; who goes on"), May::BeAbsent},
       {"advice", described(is.text, "what to do"), May::BeAbsent},
       {"plan", nullable(is.text), May::BeAbsent},
       {"mode", described(is.text, "in which it happened"), May::BeAbsent},
       {"mode_up", described(nullable(is.text), "by which it comes up again; null: no mode brings anybody up"),
        May::BeAbsent},
       {"severity", described(is.severity, "of the cause"), May::BeAbsent},
       {"stopped", is.texts, May::BeAbsent},
       {"down", described(is.texts, "who is to be up in mode_up and does not run: SET_STATE Offline starts it again"),
        May::BeAbsent},
       {"causes", described(list_of(cause), "empty, and nothing else, when nothing stopped")}});
}

void add_requests(const Basic& is, json& into) {
  into["CommandRequest"] =
      object({{"subsystem", is.text},
              {"function", is.text},
              {"arguments",
               described(map_of(is.anything),
                         "name: number (of UINT64 and INT64 also a text of its digits), name of an enumeration entry, "
                         "true or false of BOOL, words of TEXT, or a list of these"),
               May::BeAbsent},
              {"sender", is.text, May::BeAbsent},
              {"seat", described(is.text, "who commands, as in AuthorityRequest"), May::BeAbsent},
              {"confirmed", described(is.yes_or_no, "of what is to be confirmed"), May::BeAbsent}});
  into["Sent"] = object({{"id", is.whole},
                         {"apid", is.whole},
                         {"count", is.whole},
                         {"octets", described(is.text, "the packet in hexadecimal")}});
  into["Preview"] = object({{"octets", is.text},
                            {"permitted", nullable(is.yes_or_no)},
                            {"code", nullable(is.whole)},
                            {"reason", nullable(is.text)}});
  into["ModeRequest"] = object({{"mode", described(is.text, "name of a mode")}});
  into["ModePreview"] = object(
      {{"mode", is.text},
       {"against", described(is.texts, "why it would be refused; empty: it is possible")},
       {"steps", described(list_of(object({{"stage", described(is.whole, "begins when the one before has ended")},
                                           {"subsystem", is.text},
                                           {"what", is.text}})),
                           "what it would do, in order; empty: nobody moves")}});
  into["FaultRequest"] = object({{"device", is.text}, {"line", is.text}});
  into["FaultAnswer"] = object({{"answer", is.text}});
  into["Error"] = object({{"error", is.text}});
  into["Document"] = described(map_of(is.anything), "in the words of https://spec.openapis.org/oas/v3.0.3");
}

}  // namespace

json schemas() {
  json all = json::object();
  const Basic basic;
  add_mission(basic, all);
  add_status(basic, all);
  add_past(basic, all);
  add_story(basic, all);
  add_people(basic, all);
  add_requests(basic, all);
  return all;
}

}  // namespace hirosco::ground
