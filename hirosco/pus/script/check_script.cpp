// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/script/script.hpp"
#include "hirosco/pus/words/given_words.hpp"
#include "hirosco/utilities/lower_case.hpp"
#include "hirosco/utilities/nearest.hpp"

namespace hirosco::pus {
namespace {

using descriptor::Thing;

[[nodiscard]] bool same(const std::string& one, const std::string& other) {
  return lower_case(one) == lower_case(other);
}

[[nodiscard]] std::string near(const std::string& text, const std::vector<std::string_view>& known) {
  const std::string_view found = nearest(text, known);
  return found.empty() ? std::string{} : "did you mean '" + std::string{found} + "'?";
}

[[nodiscard]] std::unexpected<ScriptProblem> wrong(const ScriptLine& line, std::uint16_t column, std::string_view word,
                                                   std::string message, std::string hint) {
  return std::unexpected{ScriptProblem{.line = line.number,
                                       .column = column,
                                       .length = std::max<std::size_t>(word.size(), 1),
                                       .message = std::move(message),
                                       .hint = std::move(hint)}};
}

[[nodiscard]] std::unexpected<ScriptProblem> nobody(const ScriptLine& line,
                                                    const descriptor::SubsystemDescriptor& player, const char* does,
                                                    const char* element, const std::vector<std::string_view>& known) {
  std::string hint = near(line.subsystem, known);
  if (hint.empty())
    hint = "its descriptor says whom: <" + std::string{element} + " subsystem=\"" + line.subsystem + "\" .../>";
  return wrong(line, line.subsystem_at, line.subsystem,
               "'" + player.name + "' " + does + " no subsystem '" + line.subsystem + "'", std::move(hint));
}

[[nodiscard]] std::expected<const descriptor::Commands*, ScriptProblem> commanded_by(
    const ScriptLine& line, const descriptor::SubsystemDescriptor& player) {
  std::vector<std::string_view> known;
  for (const descriptor::Commands& each : player.commands) {
    if (same(each.subsystem, line.subsystem)) return &each;
    known.emplace_back(each.subsystem);
  }
  return nobody(line, player, "commands", "Commands", known);
}

[[nodiscard]] std::string declare(const ScriptLine& line, const char* element, const char* attribute,
                                  std::string_view thing) {
  return "<" + std::string{element} + " subsystem=\"" + line.subsystem + "\" " + attribute + "=\"... " +
         std::string{thing} + "\"/> of its descriptor permits it";
}

/// A request of ST[20] in the form of one by name.
[[nodiscard]] descriptor::Function setting_of(const Thing& parameter) {
  descriptor::Function request;
  request.name = std::string{setting_prefix} + parameter.name;
  for (const descriptor::Field& field : parameter.fields)
    request.arguments.push_back({.field = field, .of = {}, .fallback = {}});
  return request;
}

}  // namespace

std::expected<descriptor::Function, ScriptProblem> request_of(const ScriptLine& line,
                                                              const descriptor::SubsystemDescriptor& player) {
  const auto commands = commanded_by(line, player);
  if (!commands) return std::unexpected{commands.error()};
  const descriptor::Commands& permits = **commands;
  const bool setting = lower_case(line.name).starts_with(lower_case(std::string{setting_prefix}));
  std::vector<std::string_view> known;
  if (setting) {
    const std::string parameter = line.name.substr(setting_prefix.size());
    for (const Thing& each : permits.things) {
      if (each.kind != Thing::Kind::Set) continue;
      if (same(each.name, parameter)) return setting_of(each);
      known.emplace_back(each.name);
    }
    std::string hint = near(parameter, known);
    return wrong(line, line.name_at, line.name,
                 "'" + player.name + "' may not set " + parameter + " of " + line.subsystem,
                 hint.empty() ? declare(line, "Commands", "sets", parameter) : std::move(hint));
  }
  for (std::size_t i = 0; i < permits.functions.size(); ++i) {
    if (same(permits.functions[i], line.name)) {
      if (i < permits.requests.size()) return permits.requests[i];
      descriptor::Function unknown;
      unknown.name = permits.functions[i];
      return unknown;
    }
    known.emplace_back(permits.functions[i]);
  }
  std::string hint = near(line.name, known);
  if (hint.empty()) hint = declare(line, "Commands", "functions", line.name);
  if (same(line.name, "SET_STATE") || same(line.name, "CONFIGURE"))
    hint = "no subsystem changes states or configurations of another: that is what modes and plans of a mission do";
  return wrong(line, line.name_at, line.name,
               "'" + player.name + "' may not ask " + line.subsystem + " for '" + line.name + "'", std::move(hint));
}

std::expected<std::vector<std::optional<Value>>, ScriptProblem> values_of(const ScriptLine& line,
                                                                          const descriptor::Function& request) {
  auto values = values_given(request, line.words);
  if (!values)
    return wrong(line, line.words_at[values.error()], line.words[values.error()],
                 misfit_text(request, line.words, values.error()), usage_text(request));
  descriptor::Function as_function = request;
  as_function.service = 8;
  if (const auto whole = encode_request(as_function, *values); !whole)
    return wrong(line, line.name_at, line.name, std::string{"its arguments: "} + whole.error().text,
                 usage_text(request));
  return std::move(*values);
}

std::expected<const Thing*, ScriptProblem> awaited_by(const ScriptLine& line,
                                                      const descriptor::SubsystemDescriptor& player) {
  const bool event = line.kind == ScriptLine::Kind::Event;
  const auto kind = event ? Thing::Kind::Event : Thing::Kind::Read;
  const std::vector<Thing>* things = nullptr;
  bool resolved = false;
  if (event) {
    std::vector<std::string_view> heard;
    for (const descriptor::Subscribes& each : player.subscribes) {
      heard.emplace_back(each.subsystem);
      if (!same(each.subsystem, line.subsystem)) continue;
      things = &each.things;
      resolved = each.apid != 0;
    }
    if (things == nullptr) return nobody(line, player, "hears", "Subscribes", heard);
  } else {
    const auto commands = commanded_by(line, player);
    if (!commands) return std::unexpected{commands.error()};
    things = &(*commands)->things;
    resolved = (*commands)->apid != 0;
  }
  std::vector<std::string_view> known;
  for (const Thing& each : *things) {
    if (each.kind != kind) continue;
    known.emplace_back(each.name);
    if (!same(each.name, line.name)) continue;
    const bool single =
        each.fields.size() == 1 && each.fields.front().values() == 1 && each.fields.front().type != Type::Text;
    if (!event && resolved && !single)
      return wrong(line, line.name_at, line.name, "'" + line.name + "' is not a single number", "name what is in it");
    return &each;
  }
  std::string hint = near(line.name, known);
  return wrong(
      line, line.name_at, line.name,
      "'" + player.name + "' may not " + (event ? "hear" : "read") + " '" + line.name + "' of " + line.subsystem,
      hint.empty() ? declare(line, event ? "Subscribes" : "Commands", event ? "events" : "reads", line.name)
                   : std::move(hint));
}

std::optional<double> number_of(const Thing& parameter, Octets big_endian) {
  if (parameter.fields.size() != 1 || big_endian.size() != parameter.fields.front().octets()) return std::nullopt;
  OctetReader reader{big_endian};
  switch (parameter.fields.front().type) {
    case Type::Uint8: return reader.get<std::uint8_t>();
    case Type::Bool: return reader.get<std::uint8_t>();
    case Type::Int8: return reader.get<std::int8_t>();
    case Type::Uint16: return reader.get<std::uint16_t>();
    case Type::Int16: return reader.get<std::int16_t>();
    case Type::Uint32: return reader.get<std::uint32_t>();
    case Type::Int32: return reader.get<std::int32_t>();
    case Type::Uint64: return static_cast<double>(reader.get<std::uint64_t>());
    case Type::Int64: return static_cast<double>(reader.get<std::int64_t>());
    case Type::Float: return reader.get<float>();
    case Type::Double: return reader.get<double>();
    default: return std::nullopt;
  }
}

std::vector<ScriptProblem> check_script(const Script& script, const descriptor::SubsystemDescriptor& player) {
  std::vector<ScriptProblem> problems;
  for (const ScriptLine& line : script.lines) {
    if (line.kind == ScriptLine::Kind::Until || line.kind == ScriptLine::Kind::Event) {
      if (const auto thing = awaited_by(line, player); !thing) problems.push_back(thing.error());
      continue;
    }
    if (line.kind != ScriptLine::Kind::Telecommand) continue;
    const auto request = request_of(line, player);
    if (!request) {
      problems.push_back(request.error());
      continue;
    }
    const auto commands = commanded_by(line, player);
    if (commands && (*commands)->apid == 0) continue;  // no mission has said who that is
    if (const auto values = values_of(line, *request); !values) problems.push_back(values.error());
  }
  return problems;
}

}  // namespace hirosco::pus
