// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/xtce/service_reports.hpp"

#include <fmt/format.h>

#include <optional>

#include "hirosco/pus/standard_services.hpp"

namespace hirosco::ground {
namespace {

using pus::Form;
using pus::Part;
using pus::Shape;

constexpr std::uint32_t most_word_octets = 255;
constexpr unsigned word_length_bits = 8;

/// Entries for the parts of one report, in order. A list is a container of its own that is included as often as its count says.
class PartEntries {
 public:
  PartEntries(SpaceSystem& system, TypeSet& types, const PacketRoot& root)
      : system_{system}, types_{types}, root_{root} {}

  /// `octets` of the data stand before; `unknown`: that is not known. Nothing: what stands there only the packet itself can tell.
  [[nodiscard]] std::optional<std::vector<Element>> of(Shape shape, int octets) {
    std::vector<Element> entries;
    std::string id;
    for (const Part& part : shape) {
      const std::string name{part.name};
      switch (part.form) {
        case Form::Number:
          id = system_.add_parameter(name, types_.value(kind_of(part)));
          entries.push_back(entry_of(id));
          octets = behind(octets, octets_of(part.type) * part.count);
          break;
        case Form::Time:
          entries.push_back(entry_of(system_.add_parameter(name, types_.time())));
          octets = behind(octets, 7);
          break;
        case Form::Text:
          entries.push_back(
              entry_of(system_.add_parameter(name, types_.value({.type = Type::Text, .text_octets = part.count}))));
          octets = behind(octets, part.count);
          break;
        case Form::Word:
          entries.push_back(
              entry_of(system_.add_parameter(name, types_.words_behind_length(word_length_bits, most_word_octets))));
          octets = unknown;
          break;
        case Form::List: {
          const std::string count = system_.add_parameter("NUMBER_OF_" + name, types_.bits(8));
          const auto each = of(part.repeated(), unknown);
          if (!each) return std::nullopt;
          const std::string item = system_.add_container({.name = name, .says = "One of the list", .entries = *each});
          entries.push_back(entry_of(count));
          entries.push_back(included_by(item, count));
          octets = unknown;
          break;
        }
        case Form::Value:
          entries.push_back({"IndirectParameterRefEntry",
                             {{"aliasNameSpace", wire_ids}},
                             {{"ParameterInstance", {{"parameterRef", id}, {"useCalibratedValue", "false"}}}}});
          octets = unknown;
          break;
        case Form::Rest:
          if (octets == unknown) return std::nullopt;
          entries.push_back(entry_of(system_.add_parameter(
              name, types_.octets_by(root_.packet_length, -8 * (static_cast<int>(length_without_data) + octets)))));
          octets = unknown;
          break;
        case Form::Arguments: return std::nullopt;
      }
    }
    return entries;
  }

 private:
  static constexpr int unknown = -1;
  [[nodiscard]] static int behind(int octets, std::size_t more) {
    return octets == unknown ? unknown : octets + static_cast<int>(more);
  }

  SpaceSystem& system_;
  TypeSet& types_;
  const PacketRoot& root_;
};

[[nodiscard]] bool is_described_elsewhere(const pus::ServiceKind& service, const pus::ReportKind& report) {
  constexpr std::uint8_t verification = 1, housekeeping = 3, events = 5;
  const bool laid_out = !report.data.empty() && report.data.back().form == Form::Rest;
  return service.type == verification || ((service.type == housekeeping || service.type == events) && laid_out);
}

}  // namespace

ValueKind kind_of(const Part& part) {
  ValueKind kind{.type = part.type, .count = part.count};
  for (std::size_t i = 0; i < part.names.size(); ++i)
    kind.texts.push_back({static_cast<std::int64_t>(i), std::string{part.names[i]}});
  return kind;
}

void add_service_reports(SpaceSystem& system, TypeSet& types, const PacketRoot& root) {
  for (const pus::ServiceKind* service : pus::standard_services()) {
    SpaceSystem* of_service = nullptr;
    for (const pus::ReportKind& report : service->reports) {
      if (is_described_elsewhere(*service, report)) continue;
      if (of_service == nullptr)
        of_service = &system.add_system(fmt::format("ST{}", service->type), std::string{service->name});
      SpaceSystem& place = of_service->add_system(report.name, fmt::format("TM[{},{}]", service->type, report.subtype));
      auto entries = PartEntries{place, types, root}.of(report.data, 0);
      if (!entries) continue;
      entries->push_back(entry_of(root.crc));
      place.add_container(
          {.name = "report",
           .entries = std::move(*entries),
           .base = root.telemetry,
           .when = {{root.service, std::to_string(service->type)}, {root.subtype, std::to_string(report.subtype)}}});
    }
  }
}

}  // namespace hirosco::ground
