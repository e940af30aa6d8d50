// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Several series as rows of one table. Without browser.
import {silences} from './silences.js';

/// [times, values, least, most, values…] of series {t, v, low, high} on the union of their times in [from, to] and one beyond: undefined where a series has no
/// sample, which is what uPlot wants. With `held_s(series)`, for how long a sample holds: null at all times of a silence, and there is one, so that no line
/// goes across.
export function aligned(list, from, to, held_s = null) {
  const cut = list.map((series) => {
    const t = series.t;
    let first = 0, end = t.length;
    for (let low = 0, high = t.length; low < high;) {
      const middle = (low + high) >> 1;
      if (t[middle] < from) first = low = middle + 1; else high = middle;
    }
    while (end > first && t[end - 1] > to) --end;
    return [Math.max(0, first - 1), Math.min(t.length, end + 1)];
  });
  const times = new Set();
  list.forEach((series, i) => { for (let k = cut[i][0]; k < cut[i][1]; ++k) times.add(series.t[k]); });
  const silent = list.map((series, i) => held_s ? silences(series.t, cut[i][0], cut[i][1], held_s(series)) : []);
  silent.forEach((spans, i) => spans.forEach(([from]) => times.add(from + held_s(list[i]))));
  const union = Float64Array.from(times).sort();
  const rows = [union];
  list.forEach((series, i) => {
    const v = new Array(union.length), low = new Array(union.length), high = new Array(union.length);
    let k = cut[i][0], next = 0;
    for (let j = 0; j < union.length; ++j) {
      while (silent[i][next]?.[1] <= union[j]) ++next;
      const hit = k < cut[i][1] && series.t[k] === union[j];
      v[j] = hit ? series.v[k] : silent[i][next]?.[0] < union[j] ? null : undefined;
      low[j] = hit ? series.low[k] : undefined;
      high[j] = hit ? series.high[k] : undefined;
      while (k < cut[i][1] && series.t[k] <= union[j]) ++k;
    }
    rows.push(v, low, high);
  });
  return rows;
}
