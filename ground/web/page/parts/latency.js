// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What a histogram of latencies says: nine bins whose bounds double, as parts of the producer's period (docs/adr/0141).

/// Bounds of the bins in periods of the producer; the last one has none.
export const bounds = [1 / 64, 1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2];

/// At most this long took `part` of all samples, in ns: the bound of the bin in which they end, or what took longest. NaN without samples.
export function quantile_ns({counts, period_ns}, part, max_ns = Infinity) {
  const all = counts.reduce((sum, count) => sum + count, 0);
  if (!all) return NaN;
  let seen = 0;
  const bin = counts.findIndex((count) => (seen += count) >= part * all);
  return Math.min(bin < bounds.length ? bounds[bin] * period_ns : Infinity, max_ns);
}

/// Where in the picture a latency stands, in steps of a bin: bounds double. What lies beyond the last bound is in its bin.
export const place_of = (ns, period_ns) => Math.max(0, Math.min(bounds.length + 1, Math.log2(ns / period_ns) + 7));

/// Each ten times as many samples are as much higher, so one late sample of a million is seen.
export const height_of = (count, most) => count > 0 ? 0.08 + 0.92 * Math.log10(1 + count) / Math.log10(1 + most) : 0;

/// How many samples took longer than `budget_ns`: those of bins that begin there or later. A bin that it cuts is not counted.
export function late_count({counts, period_ns}, budget_ns) {
  return counts.reduce((sum, count, i) => sum + (i > 0 && bounds[i - 1] * period_ns >= budget_ns ? count : 0), 0);
}

/// Whether the longest of them is no reason to worry though it came late: there is a limit beyond `budget_ns`, and it was kept.
export const is_kept = (max_ns, limit_ns, budget_ns) => limit_ns > budget_ns && max_ns < limit_ns;
