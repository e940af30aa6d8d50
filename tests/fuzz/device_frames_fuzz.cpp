// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/data_transfer/device/power_frame.hpp"
#include "tests/fuzz/fuzz.hpp"

/// Frames of devices, of second inhibits and of switches of power, from whatever octets come: what is taken says the same when it is written
/// and read again, and no octets are frames of two kinds, so that ends which are swapped never understand each other.
namespace {

using namespace hirosco;
using fuzz::expect;

[[nodiscard]] bool same(const DeviceCommand& one, const DeviceCommand& other) {
  return one.mode == other.mode && one.epoch == other.epoch && one.sequence == other.sequence &&
         one.watchdog_us == other.watchdog_us && std::ranges::equal(one.payload, other.payload);
}
[[nodiscard]] bool same(const DeviceStatus& one, const DeviceStatus& other) {
  return one.epoch == other.epoch && one.sequence == other.sequence && one.flags == other.flags &&
         std::ranges::equal(one.payload, other.payload);
}
[[nodiscard]] bool same(const EnableCommand& one, const EnableCommand& other) {
  return one.enabled == other.enabled && one.epoch == other.epoch && one.sequence == other.sequence;
}
[[nodiscard]] bool same(const EnableStatus& one, const EnableStatus& other) {
  return one.output == other.output && one.flags == other.flags && one.epoch == other.epoch &&
         one.sequence == other.sequence;
}
[[nodiscard]] bool same(const PowerCommand& one, const PowerCommand& other) {
  return one.on == other.on && one.off_after == other.off_after && one.sequence == other.sequence;
}
[[nodiscard]] bool same(const PowerStatus& one, const PowerStatus& other) {
  return one.on == other.on && one.sequence == other.sequence;
}

/// How many kinds they were, 0 or 1.
template <class Read, class Write>
[[nodiscard]] int check_kind(Octets octets, const Read& read, const Write& write) {
  const auto frame = read(octets);
  if (!frame) return 0;
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto written = write(buffer, *frame);
  expect(written && written->size() == octets.size(), "a frame can be written as long as it was");
  const auto again = read(*written);
  expect(again && same(*again, *frame), "a frame is written and read the same");
  return 1;
}

void check(Octets octets) {
  const int kinds = check_kind(octets, read_command, write_command) + check_kind(octets, read_status, write_status) +
                    check_kind(octets, read_enable_command, write_enable_command) +
                    check_kind(octets, read_enable_status, write_enable_status) +
                    check_kind(octets, read_power_command, write_power_command) +
                    check_kind(octets, read_power_status, write_power_status);
  expect(kinds <= 1, "a frame is of one kind");
  if (kinds == 1) fuzz::taken();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Octets octets = fuzz::octets_of(data, size);
  check(octets);
  const auto sealed = fuzz::with_crc16(octets, std::endian::little);
  check(sealed);
  // What had a check sum already, with that of what it has become.
  if (octets.size() >= sizeof(std::uint16_t)) {
    const auto mended = fuzz::with_crc16(octets.first(octets.size() - sizeof(std::uint16_t)), std::endian::little);
    check(mended);
  }
  return 0;
}
