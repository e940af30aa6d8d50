// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/output_parameter.hpp"

#include <algorithm>

#include "hirosco/descriptor/model/framework_parameters.hpp"

namespace hirosco {

OutputStorage::OutputStorage(const descriptor::Device& device) {
  NaturalLayout places;
  for (const descriptor::Device::Output& output : device.output) {
    const descriptor::Field& field = output.field;
    const std::size_t offset = places.add(field.type, field.count);
    native_fields_.push_back({.type = field.type, .count = field.count, .offset = offset});
    layout_.push_back({field.type, field.count, offset});
  }
  octets_ = places.octets();
  const std::size_t words = parameter_detail::words_for(octets_);
  value_.resize(words);
  shown_words_ = std::make_unique<std::atomic<std::uint64_t>[]>(words);
}

OutputParameter::OutputParameter(const descriptor::Device& device)
    : OutputStorage{device},
      ParameterCell{{native_fields_, {}}, true, native(), &shown_sequence_, shown_words_.get()},
      device_{device},
      name_{descriptor::output_parameter(device)} {}

void OutputParameter::show(Octets payload, std::endian order) noexcept {
  decode(layout_, payload, native(), order);
  commit();
}

void OutputParameter::clear() noexcept {
  std::ranges::fill(value_, 0);
  commit();
}

}  // namespace hirosco
