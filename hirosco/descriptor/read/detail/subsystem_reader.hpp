// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/configuration_reader.hpp"
#include "hirosco/descriptor/read/detail/device_reader.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"
#include "hirosco/descriptor/read/detail/field_reader.hpp"
#include "hirosco/descriptor/read/detail/function_reader.hpp"
#include "hirosco/descriptor/read/detail/parameter_reader.hpp"
#include "hirosco/descriptor/read/detail/references.hpp"
#include "hirosco/descriptor/read/detail/service_reader.hpp"
#include "hirosco/descriptor/read/detail/services.hpp"

namespace hirosco::descriptor::detail {

/// Amounts of resources, as a subsystem and a mission say them.
[[nodiscard]] Amounts read_amounts(Attributes& attributes);
/// <Resources>.
void read_resources(const xml::Element& element, Resources& resources, Problems& problems);
/// Makes those queues of whose size nothing is said hold what it declares besides. Whether the others do, and its memory all of them.
void fit_queues(const xml::Element& root, SubsystemDescriptor& subsystem, Problems& problems);

/// Of the supervisor's own descriptor: what is not in force there is refused, wherever it stands in this element.
void check_supervisor(const xml::Element& element, Problems& problems);

/// One <Commands>, and one <Subscribes>: no subsystem in two of either.
void read_commands(const xml::Element& element, Problems& problems, Unique& commanded, std::vector<Commands>& all);
void read_subscribes(const xml::Element& element, Problems& problems, Unique& heard, std::vector<Subscribes>& all);

/// Reads one <Subsystem>. Declarations first, then what refers to them, whatever their order in the file.
class SubsystemReader {
 public:
  explicit SubsystemReader(Problems& problems) : problems_{problems} {}
  SubsystemReader(const SubsystemReader&) = delete;
  SubsystemReader& operator=(const SubsystemReader&) = delete;
  [[nodiscard]] SubsystemDescriptor read(const xml::Element& root);

 private:
  void read_head(const xml::Element& root);
  void read_hang(const xml::Element& element);
  void read_failure(const xml::Element& element);
  void read_script(const xml::Element& element);

  Problems& problems_;
  SubsystemDescriptor subsystem_;
  Unique failure_names_{"name of a failure", "E0201"};
  Unique failure_codes_{"failure code", "E0202"};
  Unique script_names_{"script", "E0201"};
  Unique commanded_{"commanded subsystem", "E0201"};
  Unique heard_{"subsystem that is heard", "E0201"};
  Unique structure_ids_{"housekeeping structure id", "E0211"};
  Unique provided_{"provided set", "E0201"};
  Unique required_{"required set", "E0201"};
  std::vector<Provides> provides_;  ///< under <Subsystem>: valid in every configuration
  std::vector<Requires> requires_;
  Duration self_test_within_{default_self_test_within};  ///< where a configuration says nothing else

  FieldReader fields_{problems_, subsystem_};
  References references_{problems_, subsystem_};
  DeviceReader devices_{problems_, subsystem_, fields_};
  BuiltInParameters built_in_{problems_, subsystem_};
  ParameterReader parameters_{problems_, subsystem_, fields_, built_in_};
  EventReader events_{problems_, subsystem_, fields_};
  FunctionReader functions_{problems_, subsystem_, fields_, references_};
  CustomServiceReader custom_services_{problems_, subsystem_, fields_, functions_};
  HousekeepingReader housekeeping_{problems_, subsystem_, references_};
  LinkSetReader link_sets_{problems_, subsystem_, fields_, references_};
  ServiceReader services_{problems_, events_, functions_, housekeeping_, link_sets_};
  ServiceListReader service_list_{problems_, subsystem_};
  ConfigurationReader configurations_{problems_, subsystem_, references_, services_, service_list_};
  BumplessReader bumpless_{problems_, subsystem_};
};

}  // namespace hirosco::descriptor::detail
