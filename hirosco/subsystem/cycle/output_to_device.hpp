// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hirosco/data_transfer/wire_layout.hpp"
#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/subsystem/author/ports.hpp"
#include "hirosco/subsystem/cycle/output_parameter.hpp"

namespace hirosco {

/// What a device is told to do: the author's output within its declared ranges, or the declared safe values, as octets of a frame.
/// Made by the service loop while the cycle rests.  Realtime: bounded by the fields, but for the constructor. Thread: the cycle.
class OutputToDevice {
 public:
  /// `layout`: of `object`, which is the author's, with the lengths that the declaration gives; all but it outlive this.
  OutputToDevice(const descriptor::Device& device, std::endian order, std::vector<LayoutField> layout,
                 ObjectFields& fields, MutableOctets object);
  [[nodiscard]] Octets safe() const noexcept { return safe_payload_; }
  /// What goes out in this cycle. `authors`: the output as the author has left it, else the safe values.
  [[nodiscard]] Octets put_out(bool authors) noexcept;
  /// Whether the author's output is further from what was put out in the cycle before than its step is wide. False where nothing of
  /// the author's was put out.
  [[nodiscard]] bool would_jump(const descriptor::SubsystemDescriptor& subsystem,
                                const descriptor::Bumpless& terms) noexcept;
  /// Where tell() shows; null: nowhere.  Thread: the service loop, while the cycle rests.
  void show_in(OutputParameter* told) noexcept { told_ = told; }
  enum class Telling : std::uint8_t {
    PutOut,  ///< what put_out() has given
    Wish,  ///< what it would have given in Operational
  };
  void tell(Telling what) noexcept;

 private:
  /// The author's, within its ranges.
  void encode_authors(MutableOctets payload) noexcept;
  /// No output leaves its declared range.
  void keep_in_range(MutableOctets payload) noexcept;

  const descriptor::Device* device_;
  std::endian order_;
  std::vector<LayoutField> layout_;
  ObjectFields* fields_;
  MutableOctets object_;
  std::vector<std::byte> safe_payload_;
  std::vector<std::byte> payload_;  ///< of the author's output, within its ranges
  std::vector<std::byte> next_payload_;  ///< room for the same, to be compared with it
  OutputParameter* told_{nullptr};
  bool passed_{false};  ///< what was put out is the author's
};

}  // namespace hirosco
