// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/native_layout.hpp"
#include "hirosco/subsystem/cycle/output_parameter.hpp"

namespace hirosco {

/// What a device is told by its subsystem: the author's output within its declared ranges, or the declared safe values, in wire form.
/// Realtime: bounded, but construction. Thread: the cycle; the service loop while that rests.
class OutputPayload {
 public:
  /// `fields` and `object`: of the author's output, which agrees with what `device` declares.
  OutputPayload(const descriptor::Device& device, ObjectFields& fields, MutableOctets object, std::endian order);

  /// The author's where `pass`, else safe values: until the next call.
  [[nodiscard]] Octets put_out(bool pass) noexcept;
  [[nodiscard]] Octets safe() const noexcept { return safe_payload_; }
  /// Where tell() shows; null: nowhere.  Thread: the service loop, while the cycle rests.
  void show_in(OutputParameter* told) noexcept { told_ = told; }
  enum class Telling : std::uint8_t {
    PutOut,  ///< what was put out
    Wish,  ///< what would have been in Operational
  };
  void tell(Telling what) noexcept;
  /// Whether the author's output is further from what was put out in the cycle before than its step is wide. False where nothing of
  /// the author's was put out.
  [[nodiscard]] bool would_jump(const descriptor::SubsystemDescriptor& subsystem,
                                const descriptor::Bumpless& terms) noexcept;

 private:
  /// No output leaves its declared range.
  void keep_in_range(MutableOctets payload) noexcept;

  const descriptor::Device* device_;
  ObjectFields* fields_;
  MutableOctets object_;
  std::endian order_;
  std::vector<LayoutField> layout_;
  std::vector<std::byte> safe_payload_;
  std::vector<std::byte> payload_;  ///< of the author's output, within its ranges
  std::vector<std::byte> next_payload_;  ///< room for the same, to be compared with it
  OutputParameter* told_{nullptr};
  bool passed_{false};  ///< what was put out is the author's
};

/// The fields of a device's output.
[[nodiscard]] std::vector<descriptor::Field> outputs_of(const descriptor::Device& device);

}  // namespace hirosco
