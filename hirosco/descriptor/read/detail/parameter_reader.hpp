// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/framework_parameters.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"
#include "hirosco/descriptor/read/detail/field_reader.hpp"

namespace hirosco::descriptor::detail {

/// The parameters that a subsystem has without declaring them.
class BuiltInParameters {
 public:
  BuiltInParameters(Problems& problems, SubsystemDescriptor& subsystem) : problems_{problems}, subsystem_{subsystem} {}
  /// True when the element names what every subsystem has: it may give a parameter its id, and is else reported.
  bool read(const xml::Element& element);
  /// The parameters of actuators, once these are known.
  void imply_outputs();
  /// Behind the author's, once these are known.
  void imply_parameters();

 private:
  void check_built_in_ids(const Parameter& built_in, const Field& field, std::uint8_t id);

  Problems& problems_;
  SubsystemDescriptor& subsystem_;
  std::vector<Parameter> built_in_{framework_parameters()};
};

/// Reads the author's parameters and enumerations.
class ParameterReader {
 public:
  ParameterReader(Problems& problems, SubsystemDescriptor& subsystem, FieldReader& fields, BuiltInParameters& built_in)
      : problems_{problems}, subsystem_{subsystem}, fields_{fields}, built_in_{built_in} {}
  void read_enumeration(const xml::Element& element);
  /// One, or what stands in <Parameters>.
  void read(const xml::Element& element);
  void read_initial_values();
  void check_foreign();

 private:
  // read_parameters.cpp
  void read_parameter(const xml::Element& element);
  /// Who may set it: writable, protection.
  void read_access(Attributes& attributes, Parameter& parameter);
  void read_persistent(Attributes& attributes, Parameter& parameter);
  // read_structures.cpp
  void read_structure(const xml::Element& element);
  // read_foreign_parameters.cpp
  /// Whose value it has: after read_access and read_persistent.
  void read_from(Attributes& attributes, Parameter& parameter);

  struct InitialValue {
    std::size_t parameter;
    std::optional<std::uint16_t> member;
    const xml::Attribute* at;
  };

  Problems& problems_;
  SubsystemDescriptor& subsystem_;
  FieldReader& fields_;
  BuiltInParameters& built_in_;
  Unique parameter_names_{"parameter name", "E0201"};
  Unique parameter_ids_{"parameter id", "E0203"};
  Unique enumeration_names_{"enumeration name", "E0201"};
  std::vector<InitialValue> initial_values_;
  std::vector<std::pair<std::size_t, const xml::Attribute*>> foreign_;  ///< which parameter, and its `from`
  std::size_t persistent_octets_{0};
};

/// The `id` attribute, which no other parameter, structure or member of this type has.
void claim_parameter_id(Attributes& attributes, Type type, std::uint8_t id, Unique& ids, Problems& problems);

}  // namespace hirosco::descriptor::detail
