// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "hirosco/pus/packet/cuc.hpp"
#include "hirosco/pus/standard_services.hpp"
#include "hirosco/utilities/octets.hpp"

/// Holds the octets of reports to the shapes by which words, exports and clients read them (docs/adr/0196). The sinks of tests do it with
/// whatever they are given.
namespace hirosco::pus::testing {

/// Octets of the value of a parameter, by its id on the wire. Empty: nobody knows, and what follows is not walked.
using ValueOctets = std::function<std::optional<std::size_t>(std::uint32_t parameter)>;

class ShapeWalk {
 public:
  ShapeWalk(Octets data, const ValueOctets& values) : reader_{data}, values_{values} {}

  /// Empty: these are octets of the shape, to their last one.
  [[nodiscard]] std::string differs_from(Shape shape) {
    const bool whole = walk(shape);
    if (!reader_.good()) return "its octets end within " + last_;
    if (!unnamed_.empty()) return unnamed_;
    return whole && reader_.remaining() != 0 ? std::to_string(reader_.remaining()) + " octets behind " + last_ : "";
  }

 private:
  /// False: nobody knows where what follows begins.
  bool walk(Shape shape) {
    for (const Part& part : shape) {
      if (!reader_.good()) return false;
      last_ = part.name;
      if (!walk(part)) return false;
    }
    return true;
  }
  bool walk(const Part& part) {
    switch (part.form) {
      case Form::Number: number(part); return true;
      case Form::Text: static_cast<void>(reader_.get(part.count)); return true;
      case Form::Word: static_cast<void>(reader_.get(reader_.get<std::uint8_t>())); return true;
      case Form::Time: static_cast<void>(reader_.get(cuc_octets)); return true;
      case Form::List:
        for (auto left = reader_.get<std::uint8_t>(); left != 0 && reader_.good(); --left)
          if (!walk(part.repeated())) return false;
        return true;
      case Form::Value: {
        const auto octets = values_ ? values_(id_) : std::nullopt;
        if (octets) static_cast<void>(reader_.get(*octets));
        return octets.has_value();
      }
      case Form::Arguments:
      case Form::Rest: static_cast<void>(reader_.get(reader_.remaining())); return true;
    }
    return false;
  }
  void number(const Part& part) {
    const Octets octets = reader_.get(octets_of(part.type) * part.count);
    if (octets.size() == sizeof id_) id_ = OctetReader{octets}.get<std::uint32_t>();
    if (octets.size() != 1 || part.names.empty() || std::to_integer<std::size_t>(octets[0]) < part.names.size()) return;
    unnamed_.append(part.name).append(" has no word for ").append(std::to_string(std::to_integer<int>(octets[0])));
  }

  OctetReader reader_;
  const ValueOctets& values_;
  std::uint32_t id_{0};  ///< the newest number of four octets
  std::string last_{"nothing"}, unnamed_;
};

/// Empty: a report of this type has such octets, or the framework has no service of this type.
[[nodiscard]] inline std::string unlike_its_shape(std::uint8_t service, std::uint8_t subtype, Octets data,
                                                  const ValueOctets& values = {}) {
  const ServiceKind* const kind = standard_service(service);
  if (kind == nullptr) return {};
  const ReportKind* const report = kind->report(subtype);
  const std::string name = "TM[" + std::to_string(service) + "," + std::to_string(subtype) + "]";
  if (report == nullptr) return name + ": its service has no such report";
  const std::string why = ShapeWalk{data, values}.differs_from(report->data);
  return why.empty() ? why : name + " is not of its shape: " + why;
}

}  // namespace hirosco::pus::testing
