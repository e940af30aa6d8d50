// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/typed_values.hpp"

#include <algorithm>
#include <limits>

#include "hirosco/subsystem/author/handler.hpp"

namespace hirosco {
namespace {

/// Smallest and largest number that the descriptor permits.
[[nodiscard]] TypeRange permitted(const pus::Argument& declared) {
  TypeRange range = range_of(declared.field.type);
  if (!declared.texts.empty()) {
    const auto [lowest, highest] = std::ranges::minmax(declared.texts, {}, &descriptor::EnumerationText::value);
    range = {lowest.value, highest.value};
  }
  return {std::max(range.lowest, declared.field.minimum.value_or(range.lowest)),
          std::min(range.highest, declared.field.maximum.value_or(range.highest))};
}

/// Whether a C++ type takes every number that the descriptor permits, as it is.
[[nodiscard]] bool holds_numbers(Type native, const pus::Argument& declared) {
  const Type type = declared.field.type;
  if (type == Type::Text) return false;
  const TypeRange wanted = permitted(declared);
  if (is_integer(native)) {
    const TypeRange held = range_of(native);
    return is_integer(type) && held.lowest <= wanted.lowest && wanted.highest <= held.highest;
  }
  if (!is_integer(type)) return native == Type::Double || type == Type::Float;
  const Number exact = std::int64_t{1} << (native == Type::Double ? std::numeric_limits<double>::digits
                                                                  : std::numeric_limits<float>::digits);
  return Number{-exact.real()} <= wanted.lowest && wanted.highest <= exact;
}

[[nodiscard]] bool holds(const NativeField& native, const pus::Argument& declared) {
  const descriptor::Field& field = declared.field;
  if (native.type == Type::Text || field.type == Type::Text) return native.type == field.type;
  return native.takes(native.type, field.count) && holds_numbers(native.type, declared);
}

/// Words come to a handler as a view of them.
[[nodiscard]] std::string native_text(const NativeField& native) {
  return native.type == Type::Text ? "std::string_view" : cpp_text(native);
}

[[nodiscard]] std::string declared_text(const pus::Argument& declared) {
  return descriptor_text(declared.field.type, declared.field.elements());
}

/// "3 (double, bool, std::array<float, 2>)"
template <class List>
[[nodiscard]] std::string listed(const List& list, std::string (*text)(const typename List::value_type&)) {
  std::string all;
  for (const auto& one : list) all.append(all.empty() ? " (" : ", ").append(text(one));
  return std::to_string(list.size()) + all + (all.empty() ? "" : ")");
}

template <class List>
[[nodiscard]] std::string joined(const List& list, std::string (*text)(const typename List::value_type&)) {
  std::string all;
  for (const auto& one : list) all.append(all.empty() ? "" : ", ").append(text(one));
  return all.empty() ? "nothing" : all;
}

}  // namespace

std::vector<std::string> handler_mistakes(const std::string& who, std::optional<std::span<const NativeField>> takes,
                                          pus::ArgumentList declared) {
  std::vector<NativeField> natives;
  if (takes) natives.assign(takes->begin(), takes->end());
  else
    for (const auto& argument : declared) natives.push_back({Type::Double, argument.field.count});
  if (natives.size() != declared.size())
    return {who + "the handler takes " + listed(natives, native_text) + ", the descriptor declares " +
            listed(declared, declared_text)};
  std::vector<std::string> mistakes;
  for (std::size_t i = 0; i < declared.size(); ++i)
    if (!holds(natives[i], declared[i]))
      mistakes.push_back(who + "argument " + std::to_string(i + 1) + ", " + declared[i].field.name +
                         ": the descriptor declares " + declared_text(declared[i]) + ", " +
                         pus::range_text(declared[i]) + "; the handler takes " + (takes ? "" : "FunctionValues, ") +
                         native_text(natives[i]) + ", which does not hold every value");
  if (!takes && pus::value_count(declared) > max_function_arguments)
    mistakes.push_back(who + "FunctionValues hold " + std::to_string(max_function_arguments) +
                       " numbers, the descriptor declares " + std::to_string(pus::value_count(declared)));
  return mistakes;
}

bool same_types(std::span<const NativeField> native, pus::ArgumentList declared) noexcept {
  return std::ranges::equal(native, declared, [](const NativeField& n, const pus::Argument& d) {
    return n.type == d.field.type && n.count == d.field.count;
  });
}

std::string types_text(std::span<const NativeField> native) { return joined(native, native_text); }
std::string types_text(pus::ArgumentList declared) { return joined(declared, declared_text); }

}  // namespace hirosco
