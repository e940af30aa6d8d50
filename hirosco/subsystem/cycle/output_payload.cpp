// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/output_payload.hpp"

#include <algorithm>
#include <cmath>

#include "hirosco/parameter/number.hpp"
#include "hirosco/subsystem/cycle/layout_difference.hpp"

namespace hirosco {
namespace {

/// Declared safe values in wire form: an actuator has them, others have zeros.
[[nodiscard]] std::vector<std::byte> safe_payload(const descriptor::Device& device, std::endian order) {
  std::vector<std::byte> payload;
  for (const auto& output : device.output) {
    const std::size_t start = payload.size();
    payload.resize(start + output.field.octets());
    OctetWriter writer{MutableOctets{payload}.subspan(start), order};
    for (std::uint32_t i = 0; i < output.field.count; ++i)
      put_number(writer, output.field.type, i < output.safe.size() ? output.safe[i] : 0.0);
  }
  return payload;
}

}  // namespace

std::vector<descriptor::Field> outputs_of(const descriptor::Device& device) {
  std::vector<descriptor::Field> fields;
  for (const auto& output : device.output) fields.push_back(output.field);
  return fields;
}

OutputPayload::OutputPayload(const descriptor::Device& device, ObjectFields& fields, MutableOctets object,
                             std::endian order)
    : device_{&device},
      fields_{&fields},
      object_{object},
      order_{order},
      layout_{agreed_layout(fields, outputs_of(device), object)},
      safe_payload_{safe_payload(device, order)},
      payload_(safe_payload_.size()),
      next_payload_(safe_payload_.size()) {}

void OutputPayload::keep_in_range(MutableOctets payload) noexcept {
  std::size_t at = 0;
  for (const auto& output : device_->output) {
    const descriptor::Field& field = output.field;
    const std::size_t octets = octets_of(field.type);
    for (std::size_t i = 0; i < field.count; ++i, at += octets) {
      const MutableOctets place = payload.subspan(at, octets);
      OctetReader reader{place, order_};
      const double wanted = get_number(reader, field.type);
      double held = wanted;
      // Also where no range is declared: an actuator is told a quantity or nothing.
      if (!std::isfinite(wanted)) held = i < output.safe.size() ? output.safe[i] : 0.0;
      if (field.minimum) held = std::max(held, field.minimum->real());
      if (field.maximum) held = std::min(held, field.maximum->real());
      if (held == wanted) continue;
      OctetWriter writer{place, order_};
      put_number(writer, field.type, held);
    }
  }
}

Octets OutputPayload::put_out(bool pass) noexcept {
  if (pass || told_ != nullptr) {
    fields_->fit(object_);
    encode(layout_, object_, payload_, order_);
    keep_in_range(payload_);
  }
  passed_ = pass;
  return Octets{pass ? payload_ : safe_payload_};
}

bool OutputPayload::would_jump(const descriptor::SubsystemDescriptor& subsystem,
                               const descriptor::Bumpless& terms) noexcept {
  if (!device_->actuator || !passed_) return false;
  fields_->fit(object_);
  encode(layout_, object_, next_payload_, order_);
  keep_in_range(next_payload_);
  OctetReader before{Octets{payload_}, order_}, next{Octets{next_payload_}, order_};
  const auto index = static_cast<std::uint16_t>(device_ - subsystem.devices.data());
  for (std::size_t output = 0; output < device_->output.size(); ++output) {
    const descriptor::Field& field = device_->output[output].field;
    const auto step = std::ranges::find_if(terms.steps, [&](const descriptor::Bumpless::Step& each) {
      return each.device == index && each.output == output;
    });
    for (std::uint32_t i = 0; i < field.count; ++i) {
      const double was = get_number(before, field.type), is = get_number(next, field.type);
      // What is no number is within no bound.
      if (step != terms.steps.end() && !(std::abs(is - was) <= step->most)) return true;
    }
  }
  return false;
}

void OutputPayload::tell(Telling what) noexcept {
  if (told_ == nullptr) return;
  const bool authors = passed_ || what == Telling::Wish;
  told_->show(Octets{authors ? payload_ : safe_payload_}, order_);
}

}  // namespace hirosco
