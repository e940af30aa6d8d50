// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/packet/packet.hpp"

/// What the descriptors of a mission say, arranged as a ground station asks: every number of telemetry is a column
/// with a name and a place in its reports. Constant after construction.
namespace hirosco::ground {

/// One value of telemetry: a parameter, a member or an element of an array.
struct Column {
  std::string name;  ///< "ARM.CUR_VALUES.POSITION[0]"
  std::uint16_t apid{};
  Type type{};
  std::uint16_t text_octets{};  ///< of TEXT: its octets in a report
  std::string unit;
  std::optional<double> minimum;
  std::optional<double> maximum;
  const descriptor::Enumeration* enumeration{nullptr};
};

/// Where a column stands in the source data of a housekeeping report.
struct Place {
  std::size_t column{};
  std::size_t offset{};  ///< in octets, structure id included
};

/// A housekeeping report as it comes: of one structure id and length.
struct Report {
  std::uint16_t apid{};
  std::uint16_t sid{};
  std::size_t octets{};
  std::uint8_t configuration{};  ///< 0 = every one
  Duration period{};
  std::vector<Place> places;  ///< of repeatedly sampled ones the newest sample
};

class Catalogue {
 public:
  explicit Catalogue(descriptor::Mission mission);
  Catalogue(const Catalogue&) = delete;
  Catalogue& operator=(const Catalogue&) = delete;

  [[nodiscard]] const descriptor::Mission& mission() const noexcept { return mission_; }
  /// The supervisor first, then the mission's order.
  [[nodiscard]] const std::vector<const descriptor::SubsystemDescriptor*>& subsystems() const noexcept {
    return subsystems_;
  }
  [[nodiscard]] const descriptor::SubsystemDescriptor* find(std::uint16_t apid) const noexcept;
  [[nodiscard]] const descriptor::SubsystemDescriptor* find(std::string_view name) const noexcept;
  /// "APID 77" when the mission has none.
  [[nodiscard]] std::string name_of(std::uint16_t apid) const;

  [[nodiscard]] const std::vector<Column>& columns() const noexcept { return columns_; }
  [[nodiscard]] std::optional<std::size_t> find_column(std::string_view name) const;
  [[nodiscard]] const std::vector<Report>& reports() const noexcept { return reports_; }
  /// The structure of a TM[3,25]; nothing when its id is unknown or its length differs.
  [[nodiscard]] const Report* report_of(std::uint16_t apid, Octets source_data) const noexcept;
  /// The number at a place of a report that report_of() has recognised, 1 of a switch that is on; not a number where words stand.
  [[nodiscard]] double read(const Place& place, Octets source_data) const noexcept;

  /// The words there; none where a number stands.
  [[nodiscard]] std::string words(const Place& place, Octets source_data) const;

  /// Requests by name, as pus::requests_of() lists them.
  [[nodiscard]] std::vector<descriptor::Function> functions_of(const descriptor::SubsystemDescriptor& subsystem) const;
  /// What the values of an argument are called: by its enumeration, or states, configurations, modes, links.
  [[nodiscard]] std::vector<descriptor::EnumerationText> texts_of(
      const descriptor::SubsystemDescriptor& subsystem, const descriptor::Function& function,
      const descriptor::Function::Argument& argument) const {
    return argument.texts.empty() ? texts_of(subsystem, function, argument.field) : argument.texts;
  }
  [[nodiscard]] std::vector<descriptor::EnumerationText> texts_of(const descriptor::SubsystemDescriptor& subsystem,
                                                                  const descriptor::Function& function,
                                                                  const descriptor::Field& argument) const;

  /// Names under which the supervisor tells about everybody; positions of the first element, empty when its descriptor
  /// has no such parameter.
  [[nodiscard]] std::optional<std::size_t> supervisor_column(std::string_view name) const;
  /// How many elements such a parameter has.
  [[nodiscard]] std::size_t supervisor_rows(std::string_view name) const;

 private:
  void add_columns(const descriptor::SubsystemDescriptor& subsystem);
  void add_reports(const descriptor::SubsystemDescriptor& subsystem, const descriptor::Configuration* configuration,
                   const std::vector<descriptor::HousekeepingStructure>& structures);
  void add_places(const descriptor::SubsystemDescriptor& subsystem,
                  const std::vector<descriptor::ParameterRef>& references, Report& report, std::size_t& offset) const;

  descriptor::Mission mission_;
  std::vector<const descriptor::SubsystemDescriptor*> subsystems_;
  std::vector<Column> columns_;
  std::unordered_map<std::string, std::size_t> column_index_;
  std::vector<Report> reports_;
};

}  // namespace hirosco::ground
