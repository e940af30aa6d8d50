// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"
#include "hirosco/descriptor/read/detail/field_reader.hpp"
#include "hirosco/descriptor/read/detail/references.hpp"
#include "hirosco/descriptor/read/detail/services.hpp"

namespace hirosco::descriptor::detail {

/// Reads functions, and the arguments of whatever is called by name. Knows who sets which parameter (docs/adr/0170).
class FunctionReader {
 public:
  FunctionReader(Problems& problems, SubsystemDescriptor& subsystem, FieldReader& fields, References& references)
      : problems_{problems}, subsystem_{subsystem}, fields_{fields}, references_{references} {}
  void read(const xml::Element& element, const Services& services);
  void read_argument(const xml::Element& element, Function& function, Unique& names);
  /// Reports a name that another has.
  void claim_name(const xml::Element& element, const Function& function);
  /// Parameters that it sets by its code.
  void read_sets(Attributes& attributes, Function& function);
  /// Once all is read: somebody sets each protection that has a range.
  void check_protections();

 private:
  void read_range_of(Attributes& attributes, Function::Argument& argument, Function& function);
  void claim_parameter(const ParameterRef& parameter, const xml::Attribute& at, const Function& function);
  [[nodiscard]] bool is_set(const ParameterRef& value) const;
  void check_arguments(const xml::Element& element, const Function& function);
  void read_fallback(Attributes& attributes, Function::Argument& argument);

  Problems& problems_;
  SubsystemDescriptor& subsystem_;
  FieldReader& fields_;
  References& references_;
  Unique function_names_{"function name", "E0201"};
  std::map<std::uint16_t, std::string> raised_by_;  ///< the function whose `sets` or argument first names a parameter
  std::vector<ParameterRef> set_;  ///< all that functions and requests name so
};

/// Reads the services of a subsystem's own.
class CustomServiceReader {
 public:
  CustomServiceReader(Problems& problems, SubsystemDescriptor& subsystem, FieldReader& fields,
                      FunctionReader& functions)
      : problems_{problems}, subsystem_{subsystem}, fields_{fields}, functions_{functions} {}
  void read(const xml::Element& element);

 private:
  void read_request(const xml::Element& element, CustomService& service, Unique& subtypes);
  void read_report(const xml::Element& element, CustomService& service, Unique& subtypes, Unique& names);

  Problems& problems_;
  SubsystemDescriptor& subsystem_;
  FieldReader& fields_;
  FunctionReader& functions_;
  Unique service_names_{"service name", "E0201"};
  Unique service_types_{"service type", "E0202"};
};

}  // namespace hirosco::descriptor::detail
