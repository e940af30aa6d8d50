// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/write_queue.hpp"

#include <algorithm>
#include <bit>

namespace hirosco {
namespace {

// A batch in its place, native order: u32 writes, then for each u32 index, i32 member, u32 octets, the value.
struct StoredWrite {
  std::uint32_t index{};
  std::int32_t member{};
  Octets value;
};

[[nodiscard]] StoredWrite next_write(OctetReader& reader) noexcept {
  StoredWrite write;
  write.index = reader.get<std::uint32_t>();
  write.member = reader.get<std::int32_t>();
  write.value = reader.get(reader.get<std::uint32_t>());
  return write;
}

void apply_batch(Octets batch, Dictionary& dictionary) noexcept {
  OctetReader staging{batch, std::endian::native};
  const auto writes = staging.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < writes; ++i) {
    const StoredWrite write = next_write(staging);
    // Accepted when it was queued; only a parameter that was withdrawn since is passed over.
    static_cast<void>(dictionary.stage(write.index, write.member, write.value));
  }
  OctetReader showing{batch.subspan(sizeof writes), std::endian::native};
  for (std::uint32_t i = 0; i < writes; ++i) dictionary.commit(next_write(showing).index);
}

}  // namespace

WriteQueue::WriteQueue(std::size_t batches, std::size_t octets_per_batch)
    : batches_{std::max<std::size_t>(batches, 1)},
      octets_per_batch_{octets_per_batch},
      storage_(batches_ * octets_per_batch_) {}

Result<> WriteQueue::enqueue(const Dictionary& dictionary, std::span<const ParameterWrite> writes) {
  std::size_t octets = sizeof(std::uint32_t);
  for (const auto& write : writes) {
    HIROSCO_TRY(dictionary.accepts(write.index, write.member, write.value));
    octets += 3 * sizeof(std::uint32_t) + write.value.size();
  }
  if (octets > octets_per_batch_)
    return fail(ErrorCode::OutOfRange, "parameter writes of one request", static_cast<std::int64_t>(octets));

  const LockGuard guard{enqueuers_};
  const std::uint64_t number = filled_.load(std::memory_order_relaxed);
  if (number - applied_.load(std::memory_order_acquire) >= batches_)
    return fail(ErrorCode::ResourceExhausted, "parameter write queue is full", static_cast<std::int64_t>(batches_));
  OctetWriter writer{place(number), std::endian::native};
  writer.put(static_cast<std::uint32_t>(writes.size()));
  for (const auto& write : writes)
    writer.put(static_cast<std::uint32_t>(write.index))
        .put(static_cast<std::int32_t>(write.member))
        .put(static_cast<std::uint32_t>(write.value.size()))
        .put(write.value);
  filled_.store(number + 1, std::memory_order_release);
  return ok();
}

bool WriteQueue::all_waiting(const std::function<bool(const ParameterWrite&)>& good) {
  // No place is filled anew meanwhile.
  const LockGuard guard{enqueuers_};
  const std::uint64_t end = filled_.load(std::memory_order_relaxed);
  for (std::uint64_t number = applied_.load(std::memory_order_acquire); number < end; ++number) {
    OctetReader batch{place(number), std::endian::native};
    for (auto writes = batch.get<std::uint32_t>(); writes > 0; --writes) {
      const StoredWrite write = next_write(batch);
      if (!good({static_cast<std::uint16_t>(write.index), write.member, write.value})) return false;
    }
  }
  return true;
}

std::size_t WriteQueue::apply(Dictionary& dictionary) noexcept {
  const std::uint64_t end = filled_.load(std::memory_order_acquire);
  const std::uint64_t begin = applied_.load(std::memory_order_relaxed);
  for (std::uint64_t number = begin; number < end; ++number) {
    apply_batch(place(number), dictionary);
    applied_.store(number + 1, std::memory_order_release);
  }
  return static_cast<std::size_t>(end - begin);
}

}  // namespace hirosco
