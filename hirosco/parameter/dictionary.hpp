// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/parameter/exact_number.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco {

/// One declared value, array or member.
struct SpecField {
  std::string name;
  Type type{Type::Double};
  std::uint32_t count{1};         ///< of TEXT: its octets
  std::optional<std::uint8_t> id{};  ///< of a member: with its type, by which it is known on the wire
  /// The elements of an array; one for a text.
  [[nodiscard]] std::size_t values() const noexcept { return type == Type::Text ? 1 : count; }
};

/// A structure within a structure: which of its fields are its own (adr 0103).
struct SpecPart {
  std::string name;
  std::size_t first{};            ///< of ParameterSpec::fields
  std::size_t count{};
  std::optional<std::uint8_t> id{};  ///< with Type::Struct
};

/// A parameter as its descriptor declares it.
struct ParameterSpec {
  std::string name;
  ParameterId id;
  std::vector<SpecField> fields;  ///< one for a value or array, the members of a structure
  bool is_struct{false};
  std::vector<Value> init{};      ///< one for each value of all fields in order, or empty (zeros, no words)
  std::vector<SpecPart> parts{};  ///< structures within, at any depth
};

/// Why a C++ type is not the declared one; `explanation` names parameter, member, C++ type and declared type.
struct LayoutMismatch {
  int member{-1};                 ///< -1: the parameter as a whole
  std::string explanation;
};
[[nodiscard]] std::optional<LayoutMismatch> compare(const ParameterSpec& spec, const ParameterCell& cell);

/// `CUR_VALUES` or `CUR_VALUES.POSITION`, resolved. `member` -1: the whole parameter; from the number of its fields on: one of
/// its parts.
struct ParameterPlace {
  std::uint16_t index{};
  int member{-1};
  friend bool operator==(const ParameterPlace&, const ParameterPlace&) = default;
};

/// The parameters of one subsystem: what the descriptor declares, and the C++ parameters published under these names.
///
/// Built and published in Software-Init by the service loop; constant while a cycle runs. From then on the functions
/// marked "the writer's" belong to the cycle, the others to any thread.
class Dictionary {
 public:
  Dictionary() = default;
  /// Refuses a name or an id that occurs twice (of members, too), a parameter without fields, a count of 0, a text of more than 254 octets, a
  /// wrong number of initial values; the text names the parameter. Realtime: allocates.
  [[nodiscard]] static std::expected<Dictionary, std::string> make(std::span<const ParameterSpec> specs);

  /// Binds a C++ parameter to its declaration. `cell` must outlive the binding. Refuses an unknown name, a second
  /// parameter of the name and a layout that differs.  Realtime: allocates.
  [[nodiscard]] std::expected<void, std::string> publish(std::string_view name, ParameterCell& cell);
  void unpublish_all() noexcept;
  /// False and the names in `missing` while a declared parameter has no C++ one.  Realtime: allocates.
  [[nodiscard]] bool all_published(std::string& missing) const;

  [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }
  /// nullptr: no such index, or not published.  Realtime: wait-free.
  [[nodiscard]] ParameterCell* cell(std::size_t index) const noexcept {
    return index < entries_.size() ? entries_[index].cell : nullptr;
  }
  [[nodiscard]] const ParameterSpec& spec(std::size_t index) const noexcept { return entries_[index].spec; }

  [[nodiscard]] std::optional<std::uint16_t> index_of(std::string_view name) const noexcept;
  /// A parameter, or a member that has an id, by ParameterId::wire().
  [[nodiscard]] std::optional<ParameterPlace> place_of(std::uint32_t wire_id) const noexcept;
  /// A parameter, `PARAMETER.MEMBER`, or a member's name alone where only one structure has it; a part is a member, too.
  [[nodiscard]] std::optional<ParameterPlace> find(std::string_view text) const noexcept;

  /// Octets on the wire (packed); 0 for a place that does not exist.  Realtime: wait-free.
  [[nodiscard]] std::size_t wire_octets(std::size_t index, int member = -1) const noexcept;

  /// Writes the live value in big-endian order; returns the octets written, 0 when the place does not exist, is not
  /// published or `big_endian` is too small.  Realtime: wait-free. Thread: the writer's.
  [[nodiscard]] std::size_t encode(std::size_t index, int member, MutableOctets big_endian) const noexcept;
  /// The same of a whole committed value; 0 also when a writer was in the way too often (try again later).
  /// Realtime: bounded. Thread: any.
  [[nodiscard]] std::size_t snapshot_encode(std::size_t index, int member, MutableOctets big_endian) const noexcept;

  /// Whether decode_into would succeed: the place is there, the length is its own, each BOOL is 0 or 1, each TEXT is one
  /// (OutOfRange).  Realtime: bounded. Thread: any.
  [[nodiscard]] Result<> accepts(std::size_t index, int member, Octets big_endian) const noexcept;
  /// Sets a place from exactly wire_octets() octets.  Realtime: bounded. Thread: the writer's.
  [[nodiscard]] Result<> decode_into(std::size_t index, int member, Octets big_endian) noexcept;
  /// decode_into without showing it to other threads before commit(): for changes that belong together.
  /// Realtime: bounded. Thread: the writer's.
  [[nodiscard]] Result<> stage(std::size_t index, int member, Octets big_endian) noexcept;
  void commit(std::size_t index) noexcept {
    if (ParameterCell* const target = cell(index)) target->commit();
  }

  /// Sets a place from values, one for each element, one for a text; each must be representable in its type (integers exactly).
  /// `value` of an error is the position of the one that is not.  Realtime: bounded. Thread: the writer's.
  [[nodiscard]] Result<> set(std::size_t index, int member, std::span<const Value> values) noexcept;
  /// initialise() gives it these from now on: as many as it has, each representable, or nothing changes.  Realtime: allocates.
  void begin_with(std::size_t index, std::vector<Value> values);
  /// Sets all published parameters to their declared initial values.  Thread: the writer's.
  [[nodiscard]] Result<> initialise() noexcept;

 private:
  struct Entry {
    ParameterSpec spec;
    ParameterCell* cell{nullptr};
  };
  /// Of the fields of a parameter: the first one of a place and how many it has; nothing of a place that does not exist.
  struct Range {
    std::size_t first{};
    std::size_t count{};
  };
  [[nodiscard]] Range range_at(std::size_t index, int member) const noexcept;
  [[nodiscard]] std::span<const NativeField> fields_at(std::size_t index, int member) const noexcept;

  std::vector<Entry> entries_;
  std::map<std::string, std::uint16_t, std::less<>> by_name_;
  std::map<std::uint32_t, ParameterPlace> by_id_;
};

}  // namespace hirosco
