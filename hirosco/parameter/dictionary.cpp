// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/dictionary.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace hirosco {
namespace {

[[nodiscard]] std::size_t value_count(const ParameterSpec& spec) noexcept {
  std::size_t sum = 0;
  for (const auto& field : spec.fields) sum += field.values();
  return sum;
}

[[nodiscard]] std::string problem_of(const ParameterSpec& spec) {
  if (spec.name.empty()) return "a parameter has no name";
  if (spec.fields.empty()) return spec.name + ": no fields";
  if (!spec.is_struct && spec.fields.size() != 1) return spec.name + ": a single value has one field";
  for (std::size_t i = 0; i < spec.fields.size(); ++i) {
    const auto& field = spec.fields[i];
    if (field.count == 0) return spec.name + "." + field.name + ": count is 0";
    if (field.type == Type::Text && field.count > max_text_octets)
      return spec.name + "." + field.name + ": a text has at most " + std::to_string(max_text_octets) + " octets";
    if (octets_of(field.type) == 0) return spec.name + "." + field.name + ": a structure is no member";
    if (spec.is_struct && std::ranges::count(spec.fields, field.name, &SpecField::name) > 1)
      return spec.name + "." + field.name + ": the structure has two members of this name";
  }
  for (const SpecPart& part : spec.parts)
    if (!spec.is_struct || part.count == 0 || part.first >= spec.fields.size() ||
        part.count > spec.fields.size() - part.first)
      return spec.name + "." + part.name + ": a part has fields of its structure";
  if (spec.id.layout != (spec.is_struct ? Type::Struct : spec.fields.front().type))
    return spec.name + ": the layout of its id is not its type";
  if (!spec.init.empty() && spec.init.size() != value_count(spec))
    return spec.name + ": " + std::to_string(spec.init.size()) + " initial values for " +
           std::to_string(value_count(spec)) + " elements";
  return {};
}

[[nodiscard]] std::size_t number_of_members(const ParameterSpec& spec) noexcept {
  return spec.is_struct ? spec.fields.size() + spec.parts.size() : 0;
}
/// A field or, from the number of fields on, a part.
[[nodiscard]] const std::string& name_of(const ParameterSpec& spec, std::size_t member) noexcept {
  return member < spec.fields.size() ? spec.fields[member].name : spec.parts[member - spec.fields.size()].name;
}

[[nodiscard]] std::string declared_text(const SpecField& field) { return descriptor_text(field.type, field.count); }
/// What is wrong when a Sized is given more than it can hold.
[[nodiscard]] std::string at_most(const NativeField& native, const SpecField& field) {
  if (native.most == 0 || native.type != field.type) return {};
  return ", which are more than " + std::to_string(native.most);
}

/// One value as its octets in big-endian order, in front of `room`; empty when the field cannot hold it.
[[nodiscard]] Octets octets_for(const NativeField& field, const Value& value,
                                std::span<std::byte, max_text_octets> room) noexcept {
  OctetWriter writer{room};
  if (field.type == Type::Text) {
    const auto* words = std::get_if<std::string>(&value);
    if (words == nullptr || words->size() > field.count || !is_text(*words)) return {};
    std::ranges::fill(room, std::byte{});
    writer.put(std::as_bytes(std::span{*words}));
    return Octets{room}.first(field.count);
  }
  const auto* number = std::get_if<Number>(&value);
  if (number == nullptr || !number->is_finite() || !write_number(writer, field.type, *number)) return {};
  return writer.written();
}

/// Whether the octets of a field are what its C++ type may hold: any number is, not any bool.
[[nodiscard]] bool holds(const NativeField& field, Octets octets) noexcept {
  if (field.type == Type::Text) return is_fixed_text(octets);
  return field.type != Type::Bool ||
         std::ranges::all_of(octets, [](std::byte octet) { return octet == std::byte{0} || octet == std::byte{1}; });
}

/// Values of a field: the elements of an array, one for a text.
[[nodiscard]] std::size_t value_count(const NativeField& field) noexcept {
  return field.type == Type::Text ? 1 : field.count;
}
/// One of them, as a field of its own.
[[nodiscard]] NativeField element(const NativeField& field, std::size_t position) noexcept {
  if (field.type == Type::Text) return field;
  return {field.type, 1, field.offset + position * octets_of(field.type)};
}

}  // namespace

std::optional<LayoutMismatch> compare(const ParameterSpec& spec, const ParameterCell& cell) {
  const auto native = cell.fields();
  if (spec.is_struct != cell.is_struct())
    return LayoutMismatch{
        -1, spec.name + ": the C++ type is " + (cell.is_struct() ? "a structure" : cpp_text(native.front())) +
                ", the descriptor declares " + (spec.is_struct ? "STRUCT" : declared_text(spec.fields.front()))};
  for (std::size_t i = 0; i < std::min(native.size(), spec.fields.size()); ++i) {
    const auto& field = spec.fields[i];
    if (native[i].takes(field.type, field.count)) continue;
    const std::string where =
        spec.is_struct ? spec.name + "." + field.name + " (member " + std::to_string(i + 1) + ")" : spec.name;
    return LayoutMismatch{spec.is_struct ? static_cast<int>(i) : -1,
                          where + ": the C++ type is " + cpp_text(native[i]) + ", the descriptor declares " +
                              declared_text(field) + at_most(native[i], field)};
  }
  if (native.size() == spec.fields.size()) return std::nullopt;
  const std::size_t first = std::min(native.size(), spec.fields.size());
  std::string text = spec.name + ": the C++ structure has " + std::to_string(native.size()) +
                     " members, the descriptor declares " + std::to_string(spec.fields.size()) + "; ";
  text += first < spec.fields.size()
              ? "C++ lacks " + spec.fields[first].name + " " + declared_text(spec.fields[first])
              : "not declared is the C++ member " + std::to_string(first + 1) + " (" + cpp_text(native[first]) + ")";
  return LayoutMismatch{static_cast<int>(first), std::move(text)};
}

std::expected<Dictionary, std::string> Dictionary::make(std::span<const ParameterSpec> specs) {
  if (specs.size() > std::numeric_limits<std::uint16_t>::max()) return std::unexpected{"more than 65535 parameters"};
  Dictionary made;
  made.entries_.reserve(specs.size());
  for (const auto& spec : specs) {
    if (std::string problem = problem_of(spec); !problem.empty()) return std::unexpected{std::move(problem)};
    const auto index = static_cast<std::uint16_t>(made.entries_.size());
    if (!made.by_name_.emplace(spec.name, index).second)
      return std::unexpected{spec.name + ": a second parameter of this name"};
    made.entries_.push_back({spec, nullptr});
    const auto claim = [&](ParameterId id, int member) -> std::string {
      const auto [other, fresh] = made.by_id_.emplace(id.wire(), ParameterPlace{index, member});
      if (fresh) return {};
      return spec.name + (member < 0 ? "" : "." + name_of(spec, static_cast<std::size_t>(member))) +
             ": has the layout and id of " + made.entries_[other->second.index].spec.name;
    };
    std::string taken = claim(spec.id, -1);
    for (std::size_t i = 0; spec.is_struct && taken.empty() && i < spec.fields.size(); ++i)
      if (spec.fields[i].id) taken = claim({spec.id.subsystem, spec.fields[i].type, *spec.fields[i].id}, int(i));
    for (std::size_t i = 0; taken.empty() && i < spec.parts.size(); ++i)
      if (spec.parts[i].id)
        taken = claim({spec.id.subsystem, Type::Struct, *spec.parts[i].id}, int(spec.fields.size() + i));
    if (!taken.empty()) return std::unexpected{std::move(taken)};
  }
  return made;
}

std::expected<void, std::string> Dictionary::publish(std::string_view name, ParameterCell& cell) {
  const auto index = index_of(name);
  if (!index) return std::unexpected{std::string{name} + ": the descriptor declares no parameter of this name"};
  Entry& entry = entries_[*index];
  if (entry.cell != nullptr) return std::unexpected{entry.spec.name + ": published twice"};
  if (auto mismatch = compare(entry.spec, cell)) return std::unexpected{std::move(mismatch->explanation)};
  for (std::size_t i = 0; i < entry.spec.fields.size(); ++i) cell.set_length(i, entry.spec.fields[i].count);
  entry.cell = &cell;
  return {};
}

void Dictionary::unpublish_all() noexcept {
  for (auto& entry : entries_) entry.cell = nullptr;
}

bool Dictionary::all_published(std::string& missing) const {
  missing.clear();
  for (const auto& entry : entries_)
    if (entry.cell == nullptr) missing += (missing.empty() ? "" : ", ") + entry.spec.name;
  return missing.empty();
}

std::optional<std::uint16_t> Dictionary::index_of(std::string_view name) const noexcept {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? std::nullopt : std::optional{found->second};
}

std::optional<ParameterPlace> Dictionary::place_of(std::uint32_t wire_id) const noexcept {
  const auto found = by_id_.find(wire_id);
  return found == by_id_.end() ? std::nullopt : std::optional{found->second};
}

std::optional<ParameterPlace> Dictionary::find(std::string_view text) const noexcept {
  if (const auto whole = index_of(text)) return ParameterPlace{*whole, -1};
  std::optional<ParameterPlace> found;
  for (std::size_t index = 0; index < entries_.size(); ++index) {
    const auto& spec = entries_[index].spec;
    const bool within = text.size() > spec.name.size() && text.starts_with(spec.name) && text[spec.name.size()] == '.';
    const std::string_view inside = within ? text.substr(spec.name.size() + 1) : std::string_view{};
    for (std::size_t member = 0; member < number_of_members(spec); ++member) {
      const std::string_view name = name_of(spec, member);
      if (name != text && (!within || name != inside)) continue;
      if (found) return std::nullopt;  // ambiguous
      found = ParameterPlace{static_cast<std::uint16_t>(index), static_cast<int>(member)};
    }
  }
  return found;
}

std::size_t Dictionary::wire_octets(std::size_t index, int member) const noexcept {
  const Range range = range_at(index, member);
  std::size_t sum = 0;
  for (std::size_t i = range.first; i < range.first + range.count; ++i) {
    const SpecField& field = entries_[index].spec.fields[i];
    sum += octets_of(field.type) * field.count;
  }
  return sum;
}

Dictionary::Range Dictionary::range_at(std::size_t index, int member) const noexcept {
  if (index >= entries_.size()) return {};
  const ParameterSpec& spec = entries_[index].spec;
  if (member < 0) return {0, spec.fields.size()};
  const auto number = static_cast<std::size_t>(member);
  if (number < spec.fields.size()) return {number, 1};
  if (number - spec.fields.size() >= spec.parts.size()) return {};
  const SpecPart& part = spec.parts[number - spec.fields.size()];
  return {part.first, part.count};
}

std::span<const NativeField> Dictionary::fields_at(std::size_t index, int member) const noexcept {
  const ParameterCell* const target = cell(index);
  if (target == nullptr) return {};
  const Range range = range_at(index, member);
  return target->fields().subspan(range.first, range.count);
}

std::size_t Dictionary::encode(std::size_t index, int member, MutableOctets big_endian) const noexcept {
  const auto fields = fields_at(index, member);
  return fields.empty() ? 0 : cell(index)->encode(fields, big_endian);
}

std::size_t Dictionary::snapshot_encode(std::size_t index, int member, MutableOctets big_endian) const noexcept {
  const auto fields = fields_at(index, member);
  return fields.empty() ? 0 : cell(index)->snapshot_encode(fields, big_endian);
}

Result<> Dictionary::accepts(std::size_t index, int member, Octets big_endian) const noexcept {
  if (index >= entries_.size()) return fail(ErrorCode::NotFound, "no parameter of this index", std::int64_t(index));
  if (cell(index) == nullptr) return fail(ErrorCode::Unavailable, "parameter not published", std::int64_t(index));
  const auto fields = fields_at(index, member);
  if (fields.empty()) return fail(ErrorCode::NotFound, "no member of this number", member);
  if (encoded_octets(fields) != big_endian.size())
    return fail(ErrorCode::Malformed, "length of a parameter value", std::int64_t(big_endian.size()));
  for (const NativeField& field : fields) {
    if (!holds(field, big_endian.first(field.octets())))
      return fail(ErrorCode::OutOfRange, field.type == Type::Bool ? "neither 0 nor 1" : "no text of this size");
    big_endian = big_endian.subspan(field.octets());
  }
  return ok();
}

Result<> Dictionary::stage(std::size_t index, int member, Octets big_endian) noexcept {
  HIROSCO_TRY(accepts(index, member, big_endian));
  cell(index)->stage_encoded(fields_at(index, member), big_endian);
  return ok();
}

Result<> Dictionary::decode_into(std::size_t index, int member, Octets big_endian) noexcept {
  HIROSCO_TRY(stage(index, member, big_endian));
  commit(index);
  return ok();
}

Result<> Dictionary::set(std::size_t index, int member, std::span<const Value> values) noexcept {
  const auto fields = fields_at(index, member);
  if (fields.empty()) return fail(ErrorCode::NotFound, "no published parameter or member", std::int64_t(index));
  std::size_t expected = 0;
  for (const auto& field : fields) expected += value_count(field);
  if (values.size() != expected) return fail(ErrorCode::Malformed, "number of values", std::int64_t(values.size()));

  // Check all before the first is set: a refused request changes nothing.
  for (const bool set : {false, true}) {
    std::size_t position = 0;
    for (const auto& field : fields) {
      for (std::size_t i = 0; i < value_count(field); ++i, ++position) {
        std::array<std::byte, max_text_octets> room;
        const Octets octets = octets_for(field, values[position], room);
        if (octets.empty())
          return fail(ErrorCode::OutOfRange, "value not representable in its type", std::int64_t(position));
        const NativeField one = element(field, i);
        if (set) cell(index)->stage_encoded({&one, 1}, octets);
      }
    }
  }
  commit(index);
  return ok();
}

void Dictionary::begin_with(std::size_t index, std::vector<Value> values) {
  if (index >= entries_.size() || values.size() != value_count(entries_[index].spec)) return;
  entries_[index].spec.init = std::move(values);
}

Result<> Dictionary::initialise() noexcept {
  for (std::size_t index = 0; index < entries_.size(); ++index) {
    const Entry& entry = entries_[index];
    if (entry.cell == nullptr) continue;
    if (!entry.spec.init.empty()) {
      HIROSCO_TRY(set(index, -1, entry.spec.init));
      continue;
    }
    constexpr std::array<std::byte, 8> zeros{};
    for (const auto& field : entry.cell->fields())
      for (std::size_t i = 0; i < field.count; ++i)
        entry.cell->stage(field.offset + i * octets_of(field.type), Octets{zeros}.first(octets_of(field.type)));
    entry.cell->commit();
  }
  return ok();
}

}  // namespace hirosco
