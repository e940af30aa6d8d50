// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <span>

#include "hirosco/data_transfer/link/latest_link.hpp"
#include "hirosco/data_transfer/memory/sealed_memory.hpp"

using namespace hirosco;

namespace {

/// A producer and a consumer of one link, as two subsystems have them.
Result<> deliver_one_sample() {
  const LinkLayout layout{.epoch = 1, .payload_octets = sizeof(double), .layout_hash = 0xC0FFEE, .period = 500us};
  SealedMemory provider;
  HIROSCO_TRY_LET(const MemoryHandle memory, provider.create("position", link_memory_octets(layout.payload_octets)));

  HIROSCO_TRY_LET(const Mapping ours, provider.map(memory, Access::ReadWrite));
  HIROSCO_TRY(provider.seal_writers(memory));  // no second writer from now on
  HIROSCO_TRY_LET(LatestWriter writer, LatestWriter::make(ours.octets, layout));

  HIROSCO_TRY(provider.verify(memory, link_memory_octets(layout.payload_octets), true));
  HIROSCO_TRY_LET(const Mapping theirs, provider.map(memory, Access::ReadOnly));
  HIROSCO_TRY_LET(LatestReader reader, LatestReader::make(theirs.octets, layout));

  const double position_rad = 0.25;
  writer.write(std::as_bytes(std::span{&position_rad, 1}), TimePoint{1ms}, LinkStatus::Valid);

  double seen_rad = 0;
  const LinkSample sample = reader.read(std::as_writable_bytes(std::span{&seen_rad, 1}));
  std::printf("sample %llu: %.2f rad\n", static_cast<unsigned long long>(sample.count), seen_rad);
  return sample.flow == Flow::New && seen_rad == position_rad ? ok() : fail(ErrorCode::Internal, "no sample");
}

}  // namespace

int main() {
  const Result<> done = deliver_one_sample();
  if (!done) std::fprintf(stderr, "%s (%lld)\n", done.error().text, static_cast<long long>(done.error().value));
  return done ? 0 : 1;
}
