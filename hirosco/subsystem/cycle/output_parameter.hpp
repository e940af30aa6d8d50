// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"

namespace hirosco {

/// Where the value of a parameter lies that has no C++ type, before the base that refers to it.
class OutputStorage {
 protected:
  explicit OutputStorage(const descriptor::Device& device);

  std::vector<NativeField> native_fields_;
  std::vector<LayoutField> layout_;
  std::vector<std::uint64_t> value_;  ///< words: numbers are aligned to their size
  std::size_t octets_{0};
  std::unique_ptr<std::atomic<std::uint64_t>[]> shown_words_;
  std::atomic<std::uint64_t> shown_sequence_{0};
  [[nodiscard]] MutableOctets native() noexcept { return std::as_writable_bytes(std::span{value_}).first(octets_); }
};

/// What is put out to an actuator, or what its author would put out, as a parameter: DEVICE_OUTPUT (adr 0073). Its members are
/// the fields of the device's output.  Thread: the writer is the cycle.
class OutputParameter final : private OutputStorage, public ParameterCell {
 public:
  explicit OutputParameter(const descriptor::Device& device);
  [[nodiscard]] const descriptor::Device& device() const noexcept { return device_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// As the device would get it: packed, in its byte order.  Realtime: bounded by the fields.
  void show(Octets payload, std::endian order) noexcept;
  /// Zeros: the device is in no use.
  void clear() noexcept;

 private:
  const descriptor::Device& device_;
  std::string name_;
};

}  // namespace hirosco
