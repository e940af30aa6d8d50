// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/xtce/types.hpp"

#include <fmt/format.h>

#include <limits>

namespace hirosco::ground {
namespace {

/// Of a second, in 24 bits.
constexpr const char* time_scale = "5.9604644775390625E-8";

[[nodiscard]] bool is_real(Type type) { return type == Type::Float || type == Type::Double; }
[[nodiscard]] bool is_signed(Type type) {
  return type == Type::Int8 || type == Type::Int16 || type == Type::Int32 || type == Type::Int64;
}

[[nodiscard]] Element units(const std::string& unit) {
  Element set{"UnitSet"};
  if (!unit.empty()) set.children.push_back({.name = "Unit", .text = unit});
  return set;
}

[[nodiscard]] Element encoding_of(Type type) {
  const std::string size = std::to_string(8 * octets_of(type));
  if (is_real(type)) return {"FloatDataEncoding", {{"sizeInBits", size}}};
  return {"IntegerDataEncoding", {{"sizeInBits", size}, {"encoding", is_signed(type) ? "twosComplement" : "unsigned"}}};
}

[[nodiscard]] Element fixed_value(const std::string& text) { return {.name = "FixedValue", .text = text}; }

/// Of a dimension from 0.
[[nodiscard]] Element dimensions(Element last) {
  return {"DimensionList",
          {},
          {{"Dimension", {}, {{"StartingIndex", {}, {fixed_value("0")}}, {"EndingIndex", {}, {std::move(last)}}}}}};
}

[[nodiscard]] Element adjusted(const char* reference, const char* attribute, const std::string& to, int slope,
                               int intercept) {
  return {"DynamicValue",
          {},
          {{reference, {{attribute, to}}},
           {"LinearAdjustment", {{"slope", std::to_string(slope)}, {"intercept", std::to_string(intercept)}}}}};
}

[[nodiscard]] Element enumerations(const std::vector<descriptor::EnumerationText>& texts) {
  Element list{"EnumerationList"};
  for (const auto& entry : texts)
    list.children.push_back({"Enumeration", {{"value", std::to_string(entry.value)}, {"label", entry.text}}});
  return list;
}

}  // namespace

ValueKind kind_of(const descriptor::Field& field, std::vector<descriptor::EnumerationText> texts) {
  return {.type = field.type,
          .count = field.text ? 1U : field.values(),
          .text_octets = field.text ? static_cast<std::uint16_t>(field.count) : field.text_octets,
          .unit = field.unit,
          .minimum = field.minimum,
          .maximum = field.maximum,
          .texts = std::move(texts),
          .words = field.text};
}

std::string TypeSet::tag(std::string_view kind) const {
  return fmt::format("{}{}Type", kind, of_ == Of::Parameters ? "Parameter" : "Argument");
}

std::string TypeSet::keep(std::string_view wanted, Element type) {
  const auto [place, is_new] = known_.emplace(xml_document(type), "");
  if (is_new) {
    place->second = names_.unique(wanted);
    type.attributes.insert(type.attributes.begin(), {"name", place->second});
    elements_.push_back(std::move(type));
  }
  return path_ + "/" + place->second;
}

void TypeSet::add_range(Element& type, const ValueKind& kind) const {
  Element range{of_ == Of::Parameters ? "CriticalRange" : "ValidRange"};
  // XTCE has a signed 64-bit number for the limit of an integer.
  const Number most{std::numeric_limits<std::int64_t>::max()};
  const auto add = [&](const char* name, const std::optional<Number>& limit) {
    if (!limit || !limit->is_finite() || (is_integer(kind.type) && *limit > most)) return;
    range.attributes.emplace_back(name, to_string(*limit));
  };
  add("minInclusive", kind.minimum);
  add("maxInclusive", kind.maximum);
  if (range.attributes.empty()) return;
  // What is told outside its promise is an alarm; what is commanded outside is not sent.
  if (of_ == Of::Parameters)
    type.children.push_back({"DefaultAlarm", {}, {{"StaticAlarmRanges", {}, {std::move(range)}}}});
  else type.children.push_back({"ValidRangeSet", {}, {std::move(range)}});
}

Element TypeSet::text(std::string_view encoding, std::uint32_t octets) const {
  Element size{"SizeInBits",
               {},
               {{"Fixed", {}, {fixed_value(std::to_string(8 * octets))}}, {.name = "TerminationChar", .text = "00"}}};
  return {
      tag("String"), {}, {units(""), {"StringDataEncoding", {{"encoding", std::string{encoding}}}, {std::move(size)}}}};
}

Element TypeSet::scalar(const ValueKind& kind) const {
  if (kind.words) return text("US-ASCII", kind.text_octets);
  if (kind.type == Type::Text) return text("UTF-8", kind.text_octets);
  if (!kind.texts.empty())
    return {tag("Enumerated"), {}, {units(kind.unit), encoding_of(kind.type), enumerations(kind.texts)}};
  if (kind.type == Type::Bool)
    return {tag("Boolean"),
            {{"oneStringValue", std::string{switch_word(true)}}, {"zeroStringValue", std::string{switch_word(false)}}},
            {units(kind.unit), encoding_of(kind.type)}};
  Element type{tag(is_real(kind.type) ? "Float" : "Integer"),
               {{"sizeInBits", std::to_string(8 * octets_of(kind.type))}},
               {units(kind.unit), encoding_of(kind.type)}};
  if (!is_real(kind.type)) type.attributes.emplace_back("signed", is_signed(kind.type) ? "true" : "false");
  if (kind.count == 1 || of_ == Of::Arguments) add_range(type, kind);
  return type;
}

std::string TypeSet::value(const ValueKind& kind) {
  std::string name{kind.words ? "WORDS" : to_text(kind.type)};
  if (kind.words || kind.type == Type::Text) name += "_" + std::to_string(kind.text_octets);
  if (!kind.unit.empty()) name += "_" + kind.unit;
  if (!kind.texts.empty()) name += "_names";
  const std::string element = keep(name, scalar(kind));
  if (kind.count == 1) return element;
  Element last = fixed_value(std::to_string(kind.count - 1));
  return keep(fmt::format("{}_x{}", name, kind.count),
              {tag("Array"), {{"arrayTypeRef", element}}, {dimensions(std::move(last))}});
}

std::string TypeSet::bits(unsigned bits) {
  const std::string size = std::to_string(bits);
  return keep("bits_" + size, {tag("Integer"),
                               {{"sizeInBits", size}, {"signed", "false"}},
                               {units(""), {"IntegerDataEncoding", {{"sizeInBits", size}}}}});
}

std::string TypeSet::crc() {
  Element rule{"CRC",
               {{"width", "16"}},
               {{.name = "Polynomial", .text = "1021"},
                {.name = "InitRemainder", .text = "FFFF"},
                {.name = "FinalXOR", .text = "0000"}}};
  Element encoding{"IntegerDataEncoding", {{"sizeInBits", "16"}}, {{"ErrorDetectCorrect", {}, {std::move(rule)}}}};
  return keep("crc_16",
              {tag("Integer"), {{"sizeInBits", "16"}, {"signed", "false"}}, {units(""), std::move(encoding)}});
}

std::string TypeSet::time() {
  return keep(
      "onboard_time",
      {tag("AbsoluteTime"),
       {},
       {{"Encoding", {{"units", "seconds"}, {"scale", time_scale}}, {{"IntegerDataEncoding", {{"sizeInBits", "56"}}}}},
        {"ReferenceTime", {}, {{.name = "Epoch", .text = "TAI"}}}}});
}

std::string TypeSet::octets_by(const std::string& parameter, int intercept_bits) {
  Element size{"SizeInBits", {}, {adjusted("ParameterInstanceRef", "parameterRef", parameter, 8, intercept_bits)}};
  return keep("octets", {tag("Binary"), {}, {units(""), {"BinaryDataEncoding", {}, {std::move(size)}}}});
}

std::string TypeSet::words_by(const std::string& parameter, int intercept_bits, std::uint32_t most_octets) {
  Element size{"Variable",
               {{"maxSizeInBits", std::to_string(8 * most_octets)}},
               {adjusted("ParameterInstanceRef", "parameterRef", parameter, 8, intercept_bits)}};
  return keep("words",
              {tag("String"), {}, {units(""), {"StringDataEncoding", {{"encoding", "UTF-8"}}, {std::move(size)}}}});
}

std::string TypeSet::words_behind_length(unsigned length_bits, std::uint32_t most_octets) {
  // XTCE wants a size of the whole even where the length stands in front; this word says that there is none. A parameter of
  // its own for the length would not do in a list: Yamcs takes the first one of the packet.
  constexpr const char* none = "_yamcs_ignore";
  Element reference = of_ == Of::Parameters ? Element{"ParameterInstanceRef", {{"parameterRef", none}}}
                                            : Element{"ArgumentInstanceRef", {{"argumentRef", none}}};
  Element size{"Variable",
               {{"maxSizeInBits", std::to_string(8 * most_octets + length_bits)}},
               {{"DynamicValue", {}, {std::move(reference)}},
                {"LeadingSize", {{"sizeInBitsOfSizeTag", std::to_string(length_bits)}}}}};
  return keep("words",
              {tag("String"), {}, {units(""), {"StringDataEncoding", {{"encoding", "UTF-8"}}, {std::move(size)}}}});
}

std::string TypeSet::list_by(const std::string& argument, const std::string& element_type) {
  Element last = adjusted("ArgumentInstanceRef", "argumentRef", argument, 1, -1);
  return keep("list", {tag("Array"), {{"arrayTypeRef", element_type}}, {dimensions(std::move(last))}});
}

std::string TypeSet::aggregate(const std::vector<std::pair<std::string, std::string>>& members) {
  Element list{"MemberList"};
  for (const auto& [name, type] : members) list.children.push_back({"Member", {{"name", name}, {"typeRef", type}}});
  return keep("structure", {tag("Aggregate"), {}, {std::move(list)}});
}

}  // namespace hirosco::ground
