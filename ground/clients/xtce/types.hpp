// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ground/clients/xtce/element.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"

/// The types of an XTCE database, each once: equal ones of all subsystems are one.
namespace hirosco::ground {

/// What a value is, from a descriptor or a table of a service.
struct ValueKind {
  Type type{Type::Uint8};
  std::uint32_t count{1};
  std::uint16_t text_octets{};
  std::string unit{};
  std::optional<Number> minimum{}, maximum{};
  std::vector<descriptor::EnumerationText> texts{};  ///< names of its values; empty = it has none
  bool words{false};  ///< its octets are words up to the first zero
};
/// Of a field; `texts` are the names of its values.
[[nodiscard]] ValueKind kind_of(const descriptor::Field& field, std::vector<descriptor::EnumerationText> texts);

/// Types of parameters, or of arguments. Every function returns the absolute path of the type.
class TypeSet {
 public:
  enum class Of : std::uint8_t { Parameters, Arguments };
  /// `path` of the space system that gets the types.
  TypeSet(Of of, std::string path) : of_{of}, path_{std::move(path)} {}

  [[nodiscard]] std::string value(const ValueKind& kind);
  [[nodiscard]] std::string bits(unsigned bits);
  /// CRC-16 of the packet: polynomial 0x1021, preset 0xFFFF.
  [[nodiscard]] std::string crc();
  /// On-board time: 4 octets of seconds, 3 of fractions, TAI since 1958.
  [[nodiscard]] std::string time();
  /// Octets, as many as 8 * `parameter` + `intercept` bits: what is left of a packet whose length the parameter says.
  [[nodiscard]] std::string octets_by(const std::string& parameter, int intercept_bits);
  /// Words, as many octets as a parameter says.
  [[nodiscard]] std::string words_by(const std::string& parameter, int intercept_bits, std::uint32_t most_octets);
  /// Words behind their length, of 8 or 16 bits.
  [[nodiscard]] std::string words_behind_length(unsigned length_bits, std::uint32_t most_octets);
  /// As many elements as another argument says.
  [[nodiscard]] std::string list_by(const std::string& argument, const std::string& element_type);
  /// Members with their types.
  [[nodiscard]] std::string aggregate(const std::vector<std::pair<std::string, std::string>>& members);

  /// All that were asked for: the children of ParameterTypeSet or ArgumentTypeSet.
  [[nodiscard]] const std::vector<Element>& elements() const noexcept { return elements_; }

 private:
  [[nodiscard]] std::string keep(std::string_view wanted, Element type);
  [[nodiscard]] std::string tag(std::string_view kind) const;
  [[nodiscard]] Element scalar(const ValueKind& kind) const;
  [[nodiscard]] Element text(std::string_view encoding, std::uint32_t octets) const;
  void add_range(Element& type, const ValueKind& kind) const;

  Of of_;
  std::string path_;
  XtceNames names_;
  std::map<std::string, std::string> known_;  ///< name by the type's own text
  std::vector<Element> elements_;
};

}  // namespace hirosco::ground
