// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "hirosco/descriptor/model/status_rows.hpp"
#include "hirosco/parameter/sized.hpp"
#include "supervisor/platform/launch/member_port.hpp"

/// What ground is told of each of us and of each link: one structure, one row (housekeeping 4702, 4703 and 4704).
namespace hirosco::supervisor {

struct MemberRow {
  static constexpr std::uint8_t not_running = 255;
  std::uint16_t apid{0};
  std::uint8_t state{not_running};
  std::uint8_t configuration{0};
  std::uint8_t inhibited{0};           ///< bits of Inhibition
  std::uint32_t cycles{0};
  std::uint32_t overruns{0};
  std::uint32_t missed{0};
  std::uint32_t latency_max_ns{0};
  std::uint32_t execution_mean_ns{0};
  std::uint32_t memory_kb{0};
};

struct LinkRow {
  /// Of a link that is not memory, samples and age: they pass nobody but its consumer.
  static constexpr std::uint32_t not_told = std::numeric_limits<std::uint32_t>::max();
  std::uint8_t link{0};
  std::uint8_t up{0};
  std::uint32_t samples{0};
  std::uint32_t age_us{0};
  std::uint32_t lost{0};
  std::uint32_t latency_mean_ns{0};
  std::uint32_t latency_max_ns{0};
  std::uint32_t jitter_ns{0};
  std::uint32_t age_at_use_us{0};
  MemberLatencies latencies;
};

/// The rows as parameters have them, by columns. Published they are as long as the descriptor says.
template <class T>
using Column = Sized<T, descriptor::most_status_rows>;
template <class T>
inline constexpr Column<T> empty_column = Column<T>::zeros(descriptor::most_status_rows);

struct MemberRows {
  Column<std::uint16_t> apid = empty_column<std::uint16_t>;
  Column<std::uint8_t> state = empty_column<std::uint8_t>;
  Column<std::uint8_t> configuration = empty_column<std::uint8_t>;
  Column<std::uint8_t> inhibited = empty_column<std::uint8_t>;
  Column<std::uint32_t> cycles = empty_column<std::uint32_t>;
  Column<std::uint32_t> overruns = empty_column<std::uint32_t>;
  Column<std::uint32_t> missed = empty_column<std::uint32_t>;
  Column<std::uint32_t> latency_max_ns = empty_column<std::uint32_t>;
  Column<std::uint32_t> execution_mean_ns = empty_column<std::uint32_t>;
  Column<std::uint32_t> memory_kb = empty_column<std::uint32_t>;
};

struct LinkRows {
  Column<std::uint8_t> link = empty_column<std::uint8_t>;
  Column<std::uint8_t> up = empty_column<std::uint8_t>;
  Column<std::uint32_t> samples = empty_column<std::uint32_t>;
  Column<std::uint32_t> age_us = empty_column<std::uint32_t>;
  Column<std::uint32_t> lost = empty_column<std::uint32_t>;
  Column<std::uint32_t> latency_mean_ns = empty_column<std::uint32_t>;
  Column<std::uint32_t> latency_max_ns = empty_column<std::uint32_t>;
};

/// LINK_QUALITY.
struct LinkQualityRows {
  Column<std::uint8_t> link = empty_column<std::uint8_t>;
  Column<std::uint32_t> lost = empty_column<std::uint32_t>;
  Column<std::uint32_t> latency_mean_ns = empty_column<std::uint32_t>;
  Column<std::uint32_t> latency_max_ns = empty_column<std::uint32_t>;
  Column<std::uint32_t> jitter_ns = empty_column<std::uint32_t>;
  Column<std::uint32_t> age_at_use_us = empty_column<std::uint32_t>;
};

/// LINK_LATENCY; a column for each bin.
struct LinkLatencyRows {
  Column<std::uint8_t> link = empty_column<std::uint8_t>;
  Column<std::uint32_t> period_ns = empty_column<std::uint32_t>;
  Column<std::uint32_t> in_1_64 = empty_column<std::uint32_t>;
  Column<std::uint32_t> in_1_32 = empty_column<std::uint32_t>;
  Column<std::uint32_t> in_1_16 = empty_column<std::uint32_t>;
  Column<std::uint32_t> in_1_8 = empty_column<std::uint32_t>;
  Column<std::uint32_t> in_1_4 = empty_column<std::uint32_t>;
  Column<std::uint32_t> in_1_2 = empty_column<std::uint32_t>;
  Column<std::uint32_t> in_1 = empty_column<std::uint32_t>;
  Column<std::uint32_t> in_2 = empty_column<std::uint32_t>;
  Column<std::uint32_t> beyond = empty_column<std::uint32_t>;
};

/// Realtime: wait-free.
inline void put(MemberRows& rows, std::size_t i, const MemberRow& status) noexcept {
  rows.apid[i] = status.apid;
  rows.state[i] = status.state;
  rows.configuration[i] = status.configuration;
  rows.inhibited[i] = status.inhibited;
  rows.cycles[i] = status.cycles;
  rows.overruns[i] = status.overruns;
  rows.missed[i] = status.missed;
  rows.latency_max_ns[i] = status.latency_max_ns;
  rows.execution_mean_ns[i] = status.execution_mean_ns;
  rows.memory_kb[i] = status.memory_kb;
}

/// Realtime: wait-free.
inline void put(LinkRows& rows, std::size_t i, const LinkRow& status) noexcept {
  rows.link[i] = status.link;
  rows.up[i] = status.up;
  rows.samples[i] = status.samples;
  rows.age_us[i] = status.age_us;
  rows.lost[i] = status.lost;
  rows.latency_mean_ns[i] = status.latency_mean_ns;
  rows.latency_max_ns[i] = status.latency_max_ns;
}

/// Realtime: wait-free.
inline void put(LinkQualityRows& rows, std::size_t i, const LinkRow& status) noexcept {
  rows.link[i] = status.link;
  rows.lost[i] = status.lost;
  rows.latency_mean_ns[i] = status.latency_mean_ns;
  rows.latency_max_ns[i] = status.latency_max_ns;
  rows.jitter_ns[i] = status.jitter_ns;
  rows.age_at_use_us[i] = status.age_at_use_us;
}

/// Realtime: wait-free.
inline void put(LinkLatencyRows& rows, std::size_t i, const LinkRow& status) noexcept {
  rows.link[i] = status.link;
  rows.period_ns[i] = status.latencies.period_ns;
  std::array<Column<std::uint32_t>*, latency_bins> bins{&rows.in_1_64, &rows.in_1_32, &rows.in_1_16,
                                                        &rows.in_1_8,  &rows.in_1_4,  &rows.in_1_2,
                                                        &rows.in_1,    &rows.in_2,    &rows.beyond};
  for (std::size_t bin = 0; bin < bins.size(); ++bin) (*bins[bin])[i] = status.latencies.counts[bin];
}

}  // namespace hirosco::supervisor
