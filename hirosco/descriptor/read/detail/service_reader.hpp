// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"
#include "hirosco/descriptor/read/detail/field_reader.hpp"
#include "hirosco/descriptor/read/detail/function_reader.hpp"
#include "hirosco/descriptor/read/detail/references.hpp"
#include "hirosco/descriptor/read/detail/services.hpp"

namespace hirosco::descriptor::detail {

/// Reads events: the author's, and what he says of the framework's.
class EventReader {
 public:
  EventReader(Problems& problems, SubsystemDescriptor& subsystem, FieldReader& fields)
      : problems_{problems}, subsystem_{subsystem}, fields_{fields} {}
  void read(const xml::Element& element, const Services& services);
  /// Once all is read: behind the author's.
  void imply_framework_events();

 private:
  Problems& problems_;
  SubsystemDescriptor& subsystem_;
  FieldReader& fields_;
  Unique event_names_{"event name", "E0201"};
  Unique event_ids_{"event id", "E0202"};
  std::vector<std::pair<const xml::Element*, Event>> framework_severities_;  ///< as the descriptor wants them
};

/// Reads housekeeping structures.
class HousekeepingReader {
 public:
  HousekeepingReader(Problems& problems, const SubsystemDescriptor& subsystem, References& references)
      : problems_{problems}, subsystem_{subsystem}, references_{references} {}
  void read(const xml::Element& element, Services& services);

 private:
  void expect_room(const xml::Element& element, const HousekeepingStructure& structure, const Services& services);

  Problems& problems_;
  const SubsystemDescriptor& subsystem_;
  References& references_;
};

/// Reads the sets of data that come and go over real-time links.
class LinkSetReader {
 public:
  LinkSetReader(Problems& problems, const SubsystemDescriptor& subsystem, FieldReader& fields, References& references)
      : problems_{problems}, subsystem_{subsystem}, fields_{fields}, references_{references} {}
  void read_provides(const xml::Element& element, Services& services);
  void read_requires(const xml::Element& element, Services& services);

 private:
  void read_lent(const xml::Element& element, std::vector<Field>& fields);
  void check_lent(const xml::Element& element, std::string_view name, const std::vector<Field>& fields);
  [[nodiscard]] LinkTerms read_terms(Attributes& attributes);
  [[nodiscard]] std::uint32_t read_depth(Attributes& attributes, LinkTerms& terms);

  Problems& problems_;
  const SubsystemDescriptor& subsystem_;
  FieldReader& fields_;
  References& references_;
};

/// Reads the services of a subsystem, or of one of its configurations.
class ServiceReader {
 public:
  ServiceReader(Problems& problems, EventReader& events, FunctionReader& functions, HousekeepingReader& housekeeping,
                LinkSetReader& link_sets)
      : problems_{problems},
        events_{events},
        functions_{functions},
        housekeeping_{housekeeping},
        link_sets_{link_sets} {}
  /// Rows for each_child(): the services, read into `services`.
  [[nodiscard]] std::vector<Child> children(Services& services);

 private:
  bool first_service(const xml::Element& element, Services& services);
  void read_test_service(const xml::Element& element, Services& services);

  Problems& problems_;
  EventReader& events_;
  FunctionReader& functions_;
  HousekeepingReader& housekeeping_;
  LinkSetReader& link_sets_;
};

/// Reads which services a subsystem offers and in which loops they run.
class ServiceListReader {
 public:
  ServiceListReader(Problems& problems, SubsystemDescriptor& subsystem) : problems_{problems}, subsystem_{subsystem} {}
  void read_service_loop(const xml::Element& element);
  /// Of the subsystem, or of one of its configurations.
  void read_service(const xml::Element& element, std::vector<ServiceUse>& uses, Unique& names, bool of_configuration);
  /// Of one of its configurations, whose loops they are otherwise.
  void read_pace_of(const xml::Element& element, std::vector<ServiceLoop>& paces, Unique& names);
  /// Once all is read; `root`: the <Subsystem>.
  void check(const xml::Element& root);
  /// Once the configuration is read.
  void check_housekeeping_offered(const xml::Element& element, const Configuration& configuration);

 private:
  /// It stays where it is, and why.
  void refuse_loop(const xml::Attribute& loop, std::string_view name);
  void read_pace(Attributes& attributes, ServiceLoop& loop);
  void refuse_pace(const xml::Attribute& name);

  Problems& problems_;
  SubsystemDescriptor& subsystem_;
  Unique loop_names_{"name of a loop", "E0201"};
};

}  // namespace hirosco::descriptor::detail
