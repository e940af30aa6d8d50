// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/descriptor/read/detail/element_reader.hpp"
#include "hirosco/descriptor/read/detail/field_reader.hpp"

namespace hirosco::descriptor::detail {

/// One <Setting> of a device, or of its simulation.
void read_setting(const xml::Element& element, Problems& problems, Unique& names, std::vector<Setting>& settings);

/// What is wrong with an address of this form; empty when nothing is. Whether it leaves this computer is the mission's matter.
[[nodiscard]] std::string refuse_address(AddressForm form, const std::string& address);

/// The means of transfer and address of an endnode.
[[nodiscard]] Endnode read_address(Attributes& attributes, Problems& problems);
/// An address belongs to one device: in all configurations, and its enable endnode to nothing else.
void check_addresses(const SubsystemDescriptor& subsystem, Problems& problems);

/// Reads each <Device> under <Subsystem>: what it exchanges.
class DeviceReader {
 public:
  DeviceReader(Problems& problems, SubsystemDescriptor& subsystem, FieldReader& fields)
      : problems_{problems}, subsystem_{subsystem}, fields_{fields} {}
  void read(const xml::Element& element);

 private:
  void read_frames(Attributes& attributes, Device device);
  void read_power(const xml::Element& element, const std::string& device);
  void check_octets(const xml::Element& element, const Device& device);
  void read_stop(Attributes& attributes, Device& device);
  void read_enable(const xml::Element& element, Device& device);
  [[nodiscard]] HeldTerms read_held_terms(Attributes& attributes, const Endnode& preferred);
  void check_goes_on(const xml::Element& element, const HeldTerms& terms);
  void read_output(const xml::Element& element, Device& device, Unique& names);

  Problems& problems_;
  SubsystemDescriptor& subsystem_;
  FieldReader& fields_;
  Unique device_names_{"device name", "E0201"};
};

/// Reads each <Device> under <Configuration>: where it is, and how it is watched.
class DeviceUseReader {
 public:
  DeviceUseReader(Problems& problems, const SubsystemDescriptor& subsystem)
      : problems_{problems}, subsystem_{subsystem} {}
  void read(const xml::Element& element, Configuration& configuration, Unique& names);

 private:
  /// Its index; empty and reported: it is not declared, or used twice.
  std::optional<std::uint16_t> find_device(const xml::Element& element, const std::string& name, Unique& names);
  void read_endnode_use(const xml::Element& element, const DeviceUse& common, const std::string& device,
                        Configuration& configuration, Unique& names);
  void read_limits(Attributes& attributes, DeviceUse& use);
  void check_limits(const xml::Element& element, const DeviceUse& use, Duration sampling);
  void check_fall_backs(const xml::Element& element, const DeviceUse& use, Duration sampling);
  void read_fall_back(const xml::Element& element, DeviceUse& use);
  void read_endnode(Attributes& attributes, DeviceUse& use);

  Problems& problems_;
  const SubsystemDescriptor& subsystem_;
};

}  // namespace hirosco::descriptor::detail
