// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/device_reader.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"
#include "hirosco/descriptor/read/detail/references.hpp"
#include "hirosco/descriptor/read/detail/service_reader.hpp"
#include "hirosco/descriptor/read/detail/services.hpp"

namespace hirosco::descriptor::detail {

/// Reads each <Configuration>.
class ConfigurationReader {
 public:
  ConfigurationReader(Problems& problems, SubsystemDescriptor& subsystem, References& references,
                      ServiceReader& services, ServiceListReader& service_list)
      : problems_{problems},
        subsystem_{subsystem},
        references_{references},
        services_{services},
        service_list_{service_list} {}
  /// `common`: what stands under <Subsystem>; `configurations`: how many there are.
  void read(const xml::Element& element, const Services& common, std::size_t configurations);

 private:
  void read_budget(Attributes& attributes, Configuration& configuration);
  void read_spin(Attributes& attributes, Configuration& configuration);
  void read_start(Attributes& attributes, Configuration& configuration);
  /// When its sets are known: the one that starts the cycle.
  void check_start(const xml::Element& element, Configuration& configuration);
  void read_set(const xml::Element& element, Configuration& configuration, Unique& names);

  Problems& problems_;
  SubsystemDescriptor& subsystem_;
  References& references_;
  ServiceReader& services_;
  ServiceListReader& service_list_;
  DeviceUseReader device_uses_{problems_, subsystem_};
  Unique configuration_names_{"configuration name", "E0201"};
  Unique configuration_ids_{"configuration id", "E0202"};
};

/// Reads between which configurations a subsystem goes while it acts.
class BumplessReader {
 public:
  BumplessReader(Problems& problems, SubsystemDescriptor& subsystem) : problems_{problems}, subsystem_{subsystem} {}
  void read(const xml::Element& element);

 private:
  void read_step(const xml::Element& element, Bumpless& bumpless, Unique& names);
  void check_steps(const xml::Element& element, const Bumpless& bumpless);

  Problems& problems_;
  SubsystemDescriptor& subsystem_;
};

}  // namespace hirosco::descriptor::detail
