// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/location.hpp"
#include "hirosco/parameter/exact_number.hpp"
#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/time.hpp"

/// Values as a descriptor declares them: fields, parameters, structures in structures, and what refers to them (paper 4.1,
/// listing 1).
namespace hirosco::descriptor {

/// The ten states (paper 4.2, figure 4). The transition table is in hirosco/subsystem/author/states.hpp.
enum class State : std::uint8_t {
  Offline = 0,
  SoftwareInit = 1,
  HardwareInit = 2,
  PreOperational = 3,
  SafeOperational = 4,
  Operational = 5,
  ErrorOperational = 6,
  PostOperational = 7,
  HardwareDeinit = 8,
  SoftwareDeinit = 9,
};

struct EnumerationText {
  std::int64_t value{};
  std::string text;
};
struct Enumeration {
  std::string name;
  std::vector<EnumerationText> texts;
};

/// A typed, named, ranged value: member, argument, link field or device field.
struct Field {
  std::string name;
  Type type{Type::Double};
  std::uint32_t count{1};  ///< array length; 1 = a single value
  std::string unit;  ///< SI, as text; empty = none
  std::optional<Number> minimum;  ///< inclusive, in `unit`
  std::optional<Number> maximum;  ///< inclusive, in `unit`
  std::string enumeration;  ///< name of an Enumeration; empty = none
  Location at;
  bool text{false};  ///< the octets are words up to the first zero; of events only
  std::uint16_t text_octets{0};  ///< of TEXT: most octets that the words take
  /// Values: the elements of an array, one for anything else.
  [[nodiscard]] std::uint32_t values() const noexcept { return type == Type::Text ? 1 : count; }
  /// Elements in memory and on the wire: of TEXT its octets.
  [[nodiscard]] std::uint32_t elements() const noexcept { return type == Type::Text ? text_octets : count; }
  /// Octets on the wire; an argument has more (Function::Argument::octets).
  [[nodiscard]] std::size_t octets() const noexcept { return octets_of(type) * elements(); }
};

/// A parameter of the dictionary: a single value or array, or a structure of such and of structures.
struct Parameter {
  Field field;  ///< for a structure: name and Type::Struct
  std::uint8_t id{};
  std::vector<Value> init;  ///< those of its field, or of all members in order; or empty (zeros, no words)
  std::uint16_t writable_states{0};  ///< bit n set: ST[20] may set it in State n; 0 = never
  bool protection{false};  ///< a limit that protects: only its own function raises it
  bool persistent{false};  ///< what telecommands set outlives the process (docs/adr/0087)
  struct Member {
    Field field;
    std::uint8_t id{};
  };
  std::vector<Member> members;  ///< of a structure, in order; those of a structure within by their way: `GAINS.P`
  /// A structure within, or one element of an array of such: members that stand beside each other (docs/adr/0103).
  struct Part {
    std::string name;  ///< its way: `GAINS`, `JOINTS[1]`, `JOINTS[1].GAINS`
    std::uint8_t id{};  ///< with Type::Struct
    std::uint16_t first{};  ///< of `members`
    std::uint16_t count{};
    Location at;
  };
  std::vector<Part> parts;  ///< at any depth
  std::string from;  ///< whose value it has: "POWER.BUS.VOLTAGE", of another subsystem (docs/adr/0103); empty: its own
  Duration age{};  ///< with `from`: what was heard counts so long, then `init`
  /// The members that a reference of this number stands for (ParameterRef::member); none of a single value or array.
  [[nodiscard]] std::span<const Member> members_at(std::optional<std::uint16_t> number) const noexcept {
    if (!number) return members;
    if (*number < members.size()) return std::span{members}.subspan(*number, 1);
    const Part& part = parts[*number - members.size()];
    return std::span{members}.subspan(part.first, part.count);
  }
  /// Type, id and name within the parameter of what a member's number stands for.
  struct Identity {
    Type type{};
    std::uint8_t id{};
    std::string_view name;
  };
  [[nodiscard]] Identity identity_of(std::uint16_t number) const noexcept {
    if (number < members.size()) return {members[number].field.type, members[number].id, members[number].field.name};
    const Part& part = parts[number - members.size()];
    return {Type::Struct, part.id, part.name};
  }
  /// How many numbers there are: members and parts.
  [[nodiscard]] std::uint16_t numbers() const noexcept {
    return static_cast<std::uint16_t>(members.size() + parts.size());
  }
  /// Octets on the wire: packed, no padding.
  [[nodiscard]] std::size_t octets(std::optional<std::uint16_t> number = {}) const noexcept {
    if (members.empty()) return field.octets();
    std::size_t sum = 0;
    for (const Member& member : members_at(number)) sum += member.field.octets();
    return sum;
  }
  [[nodiscard]] bool writable() const noexcept { return writable_states != 0; }
  [[nodiscard]] bool writable_in(State state) const noexcept {
    return (writable_states >> static_cast<int>(state) & 1) != 0;
  }
};

/// Most octets that the persistent parameters of a subsystem take together, each with 4 for its id: one report of ST[20] has them all.
inline constexpr std::size_t max_persistent_octets = 800;

/// A parameter or one member of it, resolved: `CUR_VALUES` or `CUR_VALUES.POSITION`.
struct ParameterRef {
  std::string text;  ///< as written
  std::uint16_t parameter{};  ///< index into SubsystemDescriptor::parameters
  std::optional<std::uint16_t> member;  ///< index into Parameter::members and, behind these, Parameter::parts
  Location at;
};

struct SubsystemDescriptor;

/// A parameter or what is in it, by its full name: `CUR_VALUES`, `CUR_VALUES.GAINS.P`.
[[nodiscard]] std::optional<ParameterRef> find_place(const SubsystemDescriptor& subsystem, std::string_view name);
/// What Software-Init begins with: `init`, or zeros and no words.
[[nodiscard]] std::vector<Value> values_at_begin(const Parameter& parameter);
/// Changes `init` of what a member's number stands for to as many values as that has.
void begin_with(Parameter& parameter, std::optional<std::uint16_t> member, std::vector<Value> values);
/// Whether one reference stands for all that another one does.
[[nodiscard]] bool covers(const SubsystemDescriptor& subsystem, const ParameterRef& whole, const ParameterRef& part);
/// Whether there is something that both stand for.
[[nodiscard]] bool overlap(const SubsystemDescriptor& subsystem, const ParameterRef& one, const ParameterRef& other);
/// Identity on the wire of what a reference stands for.
[[nodiscard]] ParameterId identity_of(const SubsystemDescriptor& subsystem, const ParameterRef& reference);

/// Fields a reference stands for, in wire order: one for a value or member, all members for a structure.
[[nodiscard]] std::vector<Field> fields_of(const SubsystemDescriptor& subsystem, const ParameterRef& reference);

}  // namespace hirosco::descriptor
