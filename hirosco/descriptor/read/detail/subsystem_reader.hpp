// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/descriptor/model/framework_parameters.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"

namespace hirosco::descriptor::detail {

/// Octets of a housekeeping report that are left for samples: packet 4096 less headers, checksum and structure id.
inline constexpr std::size_t max_housekeeping_octets = 4096 - 22 - 2;
/// Octets of an event's arguments: the same packet less the event's id.
inline constexpr std::size_t max_event_octets = 4096 - 22 - 2;

/// One <Setting> of a device, or of its simulation.
void read_setting(const xml::Element& element, Problems& problems, Unique& names, std::vector<Setting>& settings);

/// What is wrong with an address of this form; empty when nothing is. Whether it leaves this computer is the mission's matter.
[[nodiscard]] std::string refuse_address(AddressForm form, const std::string& address);

/// Amounts of resources, as a subsystem and a mission say them.
[[nodiscard]] Amounts read_amounts(Attributes& attributes);

/// Reads one <Subsystem>. Declarations first, then what refers to them, whatever their order in the file.
class SubsystemReader {
 public:
  explicit SubsystemReader(Problems& problems) : problems_{problems} {}
  [[nodiscard]] SubsystemDescriptor read(const xml::Element& root);

 private:
  /// What may stand once under <Subsystem> and once under each <Configuration>.
  struct Services {
    std::vector<HousekeepingStructure>& housekeeping;
    std::vector<Provides>& provides;
    std::vector<Requires>& requires_;
    Unique& structure_ids;
    Unique& provided;
    Unique& required;
    Duration& self_test_within;
    bool of_configuration{false};
    std::map<std::string, Location> seen{};
  };

  // read_subsystem.cpp
  void read_head(const xml::Element& root);
  void read_hang(const xml::Element& element);
  void read_failure(const xml::Element& element);
  void read_script(const xml::Element& element);
  void read_device(const xml::Element& element);
  void read_frames(Attributes& attributes, Device device);
  void read_power(const xml::Element& element, const std::string& device);
  void check_octets(const xml::Element& element, const Device& device);
  void read_stop(Attributes& attributes, Device& device);
  void read_enable(const xml::Element& element, Device& device);
  void read_output(const xml::Element& element, Device& device, Unique& names);

  // read_resources.cpp
  void read_resources(const xml::Element& element);
  void read_pool(const xml::Element& element);

  // read_configuration.cpp
  void read_configuration(const xml::Element& element);
  void read_budget(Attributes& attributes, Configuration& configuration);
  void read_spin(Attributes& attributes, Configuration& configuration);
  void read_start(Attributes& attributes, Configuration& configuration);
  /// When its sets are known: the one that starts the cycle.
  void check_start(const xml::Element& element, Configuration& configuration);
  void read_device_use(const xml::Element& element, Configuration& configuration, Unique& names);
  /// Its index; empty and reported: it is not declared, or used twice.
  std::optional<std::uint16_t> find_device(const xml::Element& element, const std::string& name, Unique& names);
  void read_endnode_use(const xml::Element& element, const DeviceUse& common, const std::string& device,
                        Configuration& configuration, Unique& names);
  void read_limits(Attributes& attributes, DeviceUse& use);
  void check_limits(const xml::Element& element, const DeviceUse& use, Duration sampling);
  void check_fall_backs(const xml::Element& element, const DeviceUse& use, Duration sampling);
  void read_fall_back(const xml::Element& element, DeviceUse& use);
  void read_endnode(Attributes& attributes, DeviceUse& use);
  [[nodiscard]] Endnode read_address(Attributes& attributes);
  /// An address belongs to one device: in all configurations, and its enable endnode to nothing else.
  void check_addresses();
  void read_set(const xml::Element& element, Configuration& configuration, Unique& names);

  // read_parameters.cpp
  /// True when the element names what every subsystem has: it may give a parameter its id, and is else reported.
  bool read_built_in(const xml::Element& element);
  /// The parameters of actuators, once these are known.
  void imply_outputs();
  void imply_parameters();
  void check_built_in_ids(const Parameter& built_in, const Field& field, std::uint8_t id);
  void read_parameter_element(const xml::Element& element);
  void read_enumeration(const xml::Element& element);
  void read_structure(const xml::Element& element);
  void read_parameter(const xml::Element& element);
  void read_initial_values();
  // read_structures.cpp
  struct Inside;
  [[nodiscard]] std::uint8_t read_structure_id(Attributes& attributes);
  [[nodiscard]] Inside read_inside(const xml::Element& element, int level);
  void read_member(const xml::Element& element, Inside& structure, Unique& names);
  void read_within(const xml::Element& element, Inside& outer, Unique& names, int level);
  void add_elements(Attributes& attributes, const std::string& name, std::size_t elements, const Inside& inner,
                    Inside& outer);
  void expect_ranges(const xml::Element& structure);
  /// A number that comes from outside has a range.
  void expect_range(const xml::Element& element, std::string_view what);
  /// Who may set it: writable, protection.
  void read_access(Attributes& attributes, Parameter& parameter);
  void read_persistent(Attributes& attributes, Parameter& parameter);
  void claim_parameter_id(Attributes& attributes, Type type, std::uint8_t id);
  void check_enumerations();
  /// An argument knows the names of its values.
  void name_values(std::vector<Function::Argument>& arguments);
  /// What a field says besides name, type, count and unit.
  enum class Says { Nothing, Words, Range, WordsAndRange, Argument, Report, Lent };
  [[nodiscard]] Field read_field(Attributes& attributes, Says says, NameKind kind = NameKind::Plain);
  void read_plain_field(const xml::Element& element, std::vector<Field>& fields, Unique& names,
                        Says says = Says::Nothing, NameKind kind = NameKind::Plain);
  void read_words(Attributes& attributes, Field& field);
  void check_field_range(Attributes& attributes, Field& field);
  /// The `name` attribute resolved against the parameters.
  [[nodiscard]] std::optional<ParameterRef> read_reference(Attributes& attributes, std::string_view user);
  /// `own`: how many parameters are the author's; members of the others are known by their full name only.
  void index_references(std::size_t own);
  [[nodiscard]] std::optional<ParameterRef> resolve(const xml::Attribute& name, std::string_view user);
  [[nodiscard]] std::string suggest_reference(std::string_view text) const;
  [[nodiscard]] std::size_t octets_of_reference(const ParameterRef& reference) const;

  // read_foreign.cpp
  /// Whose value it has: after read_access and read_persistent.
  void read_from(Attributes& attributes, Parameter& parameter);
  void check_foreign();

  // read_custom_service.cpp
  void read_custom_service(const xml::Element& element);
  void read_request(const xml::Element& element, CustomService& service, Unique& subtypes);
  void read_report(const xml::Element& element, CustomService& service, Unique& subtypes, Unique& names);

  // read_service_list.cpp
  void read_service_loop(const xml::Element& element);
  /// Of the subsystem, or of one of its configurations.
  void read_service(const xml::Element& element, std::vector<ServiceUse>& uses, Unique& names, bool of_configuration);
  void check_service_list(const xml::Element& root);
  void check_housekeeping_offered(const xml::Element& element, const Configuration& configuration);

  // read_bumpless.cpp
  void read_bumpless(const xml::Element& element);
  void read_step(const xml::Element& element, Bumpless& bumpless, Unique& names);
  void check_steps(const xml::Element& element, const Bumpless& bumpless);

  // read_commands.cpp
  void read_commands(const xml::Element& element);
  void read_subscribes(const xml::Element& element);

  // read_services.cpp
  /// Rows for each_child(): the services, read into `services`.
  [[nodiscard]] std::vector<Child> service_children(Services& services);
  bool first_service(const xml::Element& element, Services& services);
  void read_event(const xml::Element& element, const Services& services);
  void imply_framework_events();
  void expect_for_all(const xml::Element& element, const Services& services, std::string_view name);
  void read_function(const xml::Element& element, const Services& services);
  [[nodiscard]] static std::uint16_t read_states(Attributes& attributes, std::string_view name,
                                                 std::vector<State> fallback);
  void read_range_of(Attributes& attributes, Function::Argument& argument, const std::string& function);
  void check_arguments(const xml::Element& element, const Function& function);
  void read_fallback(Attributes& attributes, Function::Argument& argument);
  void read_argument(const xml::Element& element, Function& function, Unique& names);
  void read_test_service(const xml::Element& element, Services& services);
  void read_housekeeping(const xml::Element& element, Services& services);
  void expect_room(const xml::Element& element, const HousekeepingStructure& structure, const Services& services);
  void read_sampled(const xml::Element& element, std::vector<ParameterRef>& into, std::string_view user);
  void read_provides(const xml::Element& element, Services& services);
  void read_requires(const xml::Element& element, Services& services);
  void read_lent(const xml::Element& element, std::vector<Field>& fields);
  void check_lent(const xml::Element& element, std::string_view name, const std::vector<Field>& fields);
  [[nodiscard]] LinkTerms read_terms(Attributes& attributes);
  [[nodiscard]] std::uint32_t read_depth(Attributes& attributes, LinkTerms& terms);
  [[nodiscard]] CycleLimit read_limit(Attributes& attributes, std::string_view realtime, std::string_view reduced,
                                      CycleLimit fallback);

  struct EnumerationUse {
    const xml::Attribute* at;
    std::string name;
    Type type;
  };

  Problems& problems_;
  SubsystemDescriptor subsystem_;
  Unique parameter_names_{"parameter name", "E0201"};
  Unique parameter_ids_{"parameter id", "E0203"};
  Unique enumeration_names_{"enumeration name", "E0201"};
  Unique device_names_{"device name", "E0201"};
  Unique event_names_{"event name", "E0201"};
  Unique event_ids_{"event id", "E0202"};
  Unique failure_names_{"name of a failure", "E0201"};
  Unique failure_codes_{"failure code", "E0202"};
  Unique script_names_{"script", "E0201"};
  Unique commanded_{"commanded subsystem", "E0201"};
  Unique heard_{"subsystem that is heard", "E0201"};
  Unique function_names_{"function name", "E0201"};
  Unique service_names_{"service name", "E0201"};
  Unique service_types_{"service type", "E0202"};
  Unique loop_names_{"name of a loop", "E0201"};
  Unique service_uses_{"service", "E0201"};
  Unique configuration_names_{"configuration name", "E0201"};
  Unique configuration_ids_{"configuration id", "E0202"};
  Unique structure_ids_{"housekeeping structure id", "E0211"};
  Unique provided_{"provided set", "E0201"};
  Unique required_{"required set", "E0201"};
  std::vector<Provides> provides_;  ///< under <Subsystem>: valid in every configuration
  std::vector<Requires> requires_;
  Duration self_test_within_{default_self_test_within};  ///< where a configuration says nothing else
  std::size_t configurations_{0};  ///< that the descriptor has
  std::vector<Parameter> built_in_{framework_parameters()};
  std::vector<EnumerationUse> enumeration_uses_;
  struct InitialValue {
    std::size_t parameter;
    std::optional<std::uint16_t> member;
    const xml::Attribute* at;
  };
  std::vector<InitialValue> initial_values_;
  std::vector<std::pair<std::size_t, const xml::Attribute*>> foreign_;  ///< which parameter, and its `from`
  std::size_t persistent_octets_{0};
  std::map<std::uint16_t, std::string> raised_by_;  ///< the function whose argument is first `of` a parameter
  std::vector<std::pair<const xml::Element*, Event>> framework_severities_;  ///< as the descriptor wants them
  std::map<std::string, std::vector<ParameterRef>, std::less<>> references_;  ///< by every spelling
};

}  // namespace hirosco::descriptor::detail
