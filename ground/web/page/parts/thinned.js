// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Samples of a long time, coarser where they are old.

/// {t, v, low, high} with the first `count` samples as ranges of two each: what is kept goes back as far as before. `middle(low, high)` stands for
/// a range. A sample without a value (null) stays alone: a gap is none that is drawn across.
export function thinned({t, v, low, high}, count, middle) {
  const kept = {t: [], v: [], low: [], high: []};
  for (let i = 0; i < count; ++i) {
    const pair = i + 1 < count && v[i] !== null && v[i + 1] !== null;
    const least = pair ? Math.min(low[i] ?? v[i], low[i + 1] ?? v[i + 1]) : low[i];
    const most = pair ? Math.max(high[i] ?? v[i], high[i + 1] ?? v[i + 1]) : high[i];
    kept.t.push(t[i]);
    kept.v.push(pair ? middle(least, most) : v[i]);
    kept.low.push(least);
    kept.high.push(most);
    if (pair) ++i;
  }
  return {t: kept.t.concat(t.slice(count)), v: kept.v.concat(v.slice(count)), low: kept.low.concat(low.slice(count)), high: kept.high.concat(high.slice(count))};
}
