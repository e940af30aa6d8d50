// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/pages/page_words.hpp"

#include <algorithm>
#include <span>

namespace hirosco {
namespace {

using std::memory_order_acquire;
using std::memory_order_relaxed;
using std::memory_order_release;

// Of the words that are told first, which go as soon as they change.
constexpr std::size_t urgent_permit_octets = 4 + 4 + 8 + 4 + 4;  // epoch, stop, go, mode epoch, newest stop
constexpr std::size_t urgent_vital_octets = 6 * 4;  // state, configuration, inhibited, seen epoch, real-time, cycling

}  // namespace

void SupervisorWords::tell(OctetWriter& words) noexcept {
  // A fence between two of these loads leaves a permission without its epoch, which is none.
  words.put(permit_.epoch.load(memory_order_acquire))
      .put(permit_.stop.load(memory_order_acquire))
      .put(permit_.go.load(memory_order_acquire))
      .put(permit_.mode_epoch.load(memory_order_acquire))
      .put(permit_.newest_stop.load(memory_order_acquire))
      .put(permit_.heartbeat.load(memory_order_acquire));
}

std::size_t SupervisorWords::urgent_octets() const noexcept { return urgent_permit_octets; }

Result<> MemberWords::hear(Octets words) {
  OctetReader reader{words};
  const auto epoch = reader.get<std::uint32_t>();
  const auto stop = reader.get<std::uint32_t>();
  auto go = reader.get<std::uint64_t>();
  const auto mode_epoch = reader.get<std::uint32_t>();
  const auto newest_stop = reader.get<std::uint32_t>();
  const auto heartbeat = reader.get<std::uint64_t>();
  if (!reader.exhausted())
    return fail(ErrorCode::Malformed, "octets of permit words", static_cast<std::int64_t>(words.size()));
  if (epoch == shut_epoch_) go = 0;
  // As the writer of the page does it: no instant in which an old permission holds for a new epoch.
  if (copy_.go.load(memory_order_relaxed) != go || copy_.epoch.load(memory_order_relaxed) != epoch)
    copy_.go.store(0, memory_order_release);
  copy_.epoch.store(epoch, memory_order_release);
  copy_.stop.store(stop, memory_order_release);
  copy_.go.store(go, memory_order_release);
  copy_.mode_epoch.store(mode_epoch, memory_order_release);
  copy_.newest_stop.store(newest_stop, memory_order_release);
  copy_.heartbeat.store(heartbeat, memory_order_release);
  ++heard_;
  return ok();
}

void MemberWords::shut() noexcept {
  copy_.go.store(0, memory_order_release);
  shut_epoch_ = copy_.epoch.load(memory_order_relaxed);
}

void MemberWords::tell(OctetWriter& words) noexcept {
  const bool ours = vital_.magic == page_magic && vital_.version == page_version;
  words.put(ours ? vital_.state.load(memory_order_acquire) : CheckedWord::damaged)
      .put(vital_.configuration.load(memory_order_relaxed))
      .put(vital_.inhibited.load(memory_order_acquire))
      .put(vital_.seen_epoch.load(memory_order_acquire))
      .put(vital_.realtime.load(memory_order_relaxed))
      .put(vital_.cycling.load(memory_order_acquire));
  words.put(vital_.period_ns.load(memory_order_relaxed))
      .put(vital_.cycles.load(memory_order_acquire))
      .put(vital_.service_steps.load(memory_order_acquire))
      .put(vital_.overruns.load(memory_order_relaxed))
      .put(vital_.missed.load(memory_order_relaxed))
      .put(vital_.latency_max_ns.load(memory_order_relaxed))
      .put(vital_.execution_max_ns.load(memory_order_relaxed))
      .put(vital_.execution_mean_ns.load(memory_order_relaxed))
      .put(vital_.lost_reports.load(memory_order_relaxed))
      .put(vital_.inhibited_at_cycle.load(memory_order_relaxed));
  // Those of the configuration in force stand first: what comes behind the last link that is there says nothing.
  const auto last =
      std::ranges::find_if(vital_.incoming.rbegin(), vital_.incoming.rend(),
                           [](const IncomingLink& link) { return link.link.load(memory_order_relaxed) != 0; });
  const auto used = static_cast<std::size_t>(vital_.incoming.rend() - last);
  words.put(static_cast<std::uint32_t>(used));
  for (const IncomingLink& link : std::span{vital_.incoming}.first(used))
    words.put(link.link.load(memory_order_relaxed))
        .put(link.lost.load(memory_order_relaxed))
        .put(link.latency_mean_ns.load(memory_order_relaxed))
        .put(link.latency_max_ns.load(memory_order_relaxed))
        .put(link.jitter_ns.load(memory_order_relaxed))
        .put(link.age_us.load(memory_order_relaxed));
}

std::size_t MemberWords::urgent_octets() const noexcept { return urgent_vital_octets; }

Result<> SupervisorWords::hear(Octets words) {
  constexpr std::size_t head = urgent_vital_octets + 5 * 8 + 4 * 4 + 8, each = 6 * 4;
  std::uint32_t used = 0;
  if (words.size() >= head + sizeof used) used = OctetReader{words.subspan(head)}.get<std::uint32_t>();
  if (used > told_incoming_links || words.size() != head + sizeof used + used * each)
    return fail(ErrorCode::Malformed, "octets of vital words", static_cast<std::int64_t>(words.size()));
  OctetReader reader{words};
  const auto u32 = [&] { return reader.get<std::uint32_t>(); };
  const auto u64 = [&] { return reader.get<std::uint64_t>(); };
  copy_.state.store(u32(), memory_order_release);
  copy_.configuration.store(u32(), memory_order_relaxed);
  copy_.inhibited.store(u32(), memory_order_release);
  copy_.seen_epoch.store(u32(), memory_order_release);
  copy_.realtime.store(u32(), memory_order_relaxed);
  copy_.cycling.store(u32(), memory_order_release);
  copy_.period_ns.store(u64(), memory_order_relaxed);
  copy_.cycles.store(u64(), memory_order_release);
  copy_.service_steps.store(u64(), memory_order_release);
  copy_.overruns.store(u64(), memory_order_relaxed);
  copy_.missed.store(u64(), memory_order_relaxed);
  copy_.latency_max_ns.store(u32(), memory_order_relaxed);
  copy_.execution_max_ns.store(u32(), memory_order_relaxed);
  copy_.execution_mean_ns.store(u32(), memory_order_relaxed);
  copy_.lost_reports.store(u32(), memory_order_relaxed);
  copy_.inhibited_at_cycle.store(u64(), memory_order_relaxed);
  static_cast<void>(u32());
  for (IncomingLink& link : std::span{copy_.incoming}.subspan(used)) link.link.store(0, memory_order_relaxed);
  for (IncomingLink& link : std::span{copy_.incoming}.first(used)) {
    link.link.store(u32(), memory_order_relaxed);
    link.lost.store(u32(), memory_order_relaxed);
    link.latency_mean_ns.store(u32(), memory_order_relaxed);
    link.latency_max_ns.store(u32(), memory_order_relaxed);
    link.jitter_ns.store(u32(), memory_order_relaxed);
    link.age_us.store(u32(), memory_order_relaxed);
  }
  return ok();
}

}  // namespace hirosco
