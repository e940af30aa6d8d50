// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "hirosco/pus/st08_function/function_service.hpp"
#include "tests/fuzz/fuzz.hpp"

/// Arguments of functions and of requests to own services, of every type, from whatever octets come. What is taken is what
/// the descriptor permits, and goes back to the octets that it came from.
namespace {

using namespace hirosco;
using pus::Argument;

[[nodiscard]] Argument argument(const char* name, Type type, std::uint16_t count = 1) {
  Argument made;
  made.field.name = name;
  made.field.type = type;
  made.field.count = count;
  return made;
}

[[nodiscard]] descriptor::Function every_type() {
  descriptor::Function function;
  function.name = "PROGRAM";
  Argument serial = argument("SERIAL", Type::Uint64);
  serial.field.minimum = Number{(std::uint64_t{1} << 53) + 1};
  Argument offset = argument("OFFSET", Type::Int64, 2);
  offset.field.maximum = Number{0};
  Argument colour = argument("COLOUR", Type::Int16);
  colour.texts = {{-1, "red"}, {7, "green"}};
  Argument note = argument("NOTE", Type::Text);
  note.field.text_octets = 9;
  Argument rates = argument("RATES", Type::Float, 3);
  rates.field.minimum = Number{-1};
  rates.field.maximum = Number{0.5};
  Argument on = argument("ON", Type::Bool, 2);
  on.texts = {{0, "off"}, {1, "on"}};
  on.fallback = Number{1};
  Argument title = argument("TITLE", Type::Text);
  title.field.text_octets = 200;
  title.fallback = std::string{"-"};
  function.arguments = {serial, offset, colour, note, rates, on, title};
  return function;
}

using fuzz::expect;

/// All values of a list are permitted, and are the octets that they came from.
void check_list(pus::ArgumentList declared, Octets list) {
  fuzz::taken();
  pus::ArgumentReader reader{declared, list};
  const std::vector<Value> values = reader.rest();
  expect(reader.good() && values.size() == pus::value_count(declared), "a list has all its values");
  auto value = values.begin();
  for (const Argument& each : declared)
    for (std::size_t i = 0; i < pus::value_count(each); ++i, ++value) {
      const auto* text = std::get_if<std::string>(&*value);
      expect(text != nullptr ? pus::permits(each, *text) : pus::permits(each, std::get<Number>(*value)),
             "what was taken is permitted");
      static_cast<void>(pus::value_text(each, *value));
    }
  const std::vector<std::optional<Value>> given(values.begin(), values.end());
  std::vector<std::byte> again;
  expect(pus::append_values(again, declared, given, pus::Ids::None).has_value(), "what was taken can be sent");
  expect(std::ranges::equal(again, list.first(again.size())), "a list is the octets that it came from");
}

/// As many different ids as it says, by the declared widths alone.
[[nodiscard]] bool gives_each_once(const descriptor::Function& function, Octets given) {
  OctetReader reader{given};
  std::set<unsigned> ids;
  const unsigned count = reader.get<std::uint8_t>();
  for (unsigned i = 0; i < count; ++i) {
    const unsigned id = reader.get<std::uint8_t>();
    const auto& field = function.arguments.at(id - 1).field;
    ids.insert(id);
    static_cast<void>(reader.get(field.type == Type::Text ? reader.get<std::uint16_t>() : field.octets()));
  }
  return reader.exhausted() && ids.size() == count;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const descriptor::Function function = every_type();
  const Octets octets = std::as_bytes(std::span{data, size});

  // Of an own service: in order, without ids.
  if (const auto wrong = pus::first_not_permitted(function.arguments, octets); wrong && *wrong == 0)
    check_list(function.arguments, octets);

  // Of a function: with ids, in any order.
  std::vector<std::byte> call(pus::function_name_octets);
  std::ranges::copy(std::as_bytes(std::span{function.name}), call.begin());
  call.insert(call.end(), octets.begin(), octets.end());
  if (const auto taken = pus::decode_call({&function, 1}, call)) {
    check_list(function.arguments, taken->arguments);
    expect(gives_each_once(function, octets), "a call gives no argument twice");
  }

  // As somebody types it.
  const std::string typed{reinterpret_cast<const char*>(data), size};
  for (const Argument& each : function.arguments)
    if (const auto value = pus::parse_value(each, typed)) {
      std::vector<std::byte> sent;
      static_cast<void>(pus::append_value(sent, each, *value));
    }
  return 0;
}
