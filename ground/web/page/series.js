// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Samples of the parameters that are drawn: the past from the archive, then what the feed brings. Shared between plots.
import {get} from './api.js';
import {flight, gateway, newest_s, now_s, on_values, replay} from './store.js';

const most_samples = 40000;
const longest_window_s = 3600;
const backlog_points = 3000;

const known = new Map();

class Series {
  t = [];
  v = [];
  /// Ranges of buckets where the archive has more samples than points; drawn as a band.
  low = [];
  high = [];
  from = Infinity;
  uses = 0;
  version = 0;
  asked = null;

  constructor(name) {
    this.name = name;
  }

  push(t, v) {
    if (this.t.length && t <= this.t[this.t.length - 1]) return;
    this.t.push(t);
    this.v.push(Number.isFinite(v) ? v : null);
    this.low.push(null);
    this.high.push(null);
    if (this.t.length > most_samples) for (const list of [this.t, this.v, this.low, this.high]) list.splice(0, most_samples / 8);
    ++this.version;
  }

  /// The archive from `from` on, before what is here already.
  async fetch(from) {
    const to = Math.min(this.t[0] ?? Infinity, now_s());
    if (!Number.isFinite(to) || from >= this.from || from >= to) return;
    const before = this.from;
    this.from = from;
    try {
      const answer = await get('/api/history', {parameter: this.name, from, to, points: backlog_points});
      const middle = answer.v ?? answer.min.map((low, i) => (low + answer.max[i]) / 2);
      let end = answer.t.length;
      const first = this.t[0] ?? Infinity;
      while (end > 0 && answer.t[end - 1] >= first) --end;
      const part = (list) => list.slice(0, end).map((value) => Number.isFinite(value) ? value : null);
      const empty = () => new Array(end).fill(null);
      this.t = answer.t.slice(0, end).concat(this.t);
      this.v = part(middle).concat(this.v);
      this.low = (answer.min ? part(answer.min) : empty()).concat(this.low);
      this.high = (answer.max ? part(answer.max) : empty()).concat(this.high);
      ++this.version;
    } catch {
      this.from = before;
    }
  }

  forget() {
    this.t = [];
    this.v = [];
    this.low = [];
    this.high = [];
    this.from = Infinity;
    ++this.version;
  }
}

export function use_series(name, window_s) {
  let series = known.get(name);
  if (!series) known.set(name, series = new Series(name));
  ++series.uses;
  extend(series, window_s);
  return series;
}

export function extend(series, window_s) {
  const newest = newest_s();
  // Nothing of an earlier flight, but in a replay of it.
  const began = replay.value ? -Infinity : flight.value?.from ?? -Infinity;
  if (Number.isFinite(newest)) series.fetch(Math.max(began, newest - Math.min(longest_window_s, window_s) - 1));
}

export function drop_series(series) {
  if (--series.uses <= 0) known.delete(series.name);
}

on_values((set) => {
  for (const series of known.values()) {
    const sample = set[series.name];
    if (!sample) continue;
    const [v, t] = Array.isArray(sample) ? sample : [sample.v, sample.t];
    // A clock that jumps back by itself is a new flight; in a replay it is a seek.
    if (series.t.length && t < series.t[series.t.length - 1] - 5) series.forget();
    series.push(t, typeof v === 'boolean' ? Number(v) : v);
  }
});

/// What the archive got while the page had no gateway comes from there: a line over the time between would be a lie.
let was_connected = true;
gateway.subscribe(({connected}) => {
  if (connected && !was_connected) {
    for (const series of known.values()) {
      const from = series.from;
      series.forget();
      if (Number.isFinite(from)) series.fetch(from);
    }
  }
  was_connected = connected;
});

let flown = null;
flight.subscribe((value) => {
  if (flown !== null && value && value.id !== flown && !replay.peek()) for (const series of known.values()) series.forget();
  flown = value?.id ?? flown;
});

let was = null;
replay.subscribe((value) => {
  const is = value ? 'replay' : 'live';
  if (was !== null && was !== is) for (const series of known.values()) series.forget();
  was = is;
});

/// Rows on the union of the times, nulls where a series has no sample: what uPlot wants.
export function aligned(list, from, to) {
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
  const union = Float64Array.from(times).sort();
  const rows = [union];
  list.forEach((series, i) => {
    const v = new Array(union.length), low = new Array(union.length), high = new Array(union.length);
    let k = cut[i][0];
    for (let j = 0; j < union.length; ++j) {
      const hit = k < cut[i][1] && series.t[k] === union[j];
      v[j] = hit ? series.v[k] : undefined;
      low[j] = hit ? series.low[k] : undefined;
      high[j] = hit ? series.high[k] : undefined;
      while (k < cut[i][1] && series.t[k] <= union[j]) ++k;
    }
    rows.push(v, low, high);
  });
  return rows;
}

export const has_samples = ({t, v}, from, to) => t.some((at, i) => at >= from && at <= to && v[i] !== null);

/// The newest sample up to `t`; undefined where there is none.
export function value_at(name, t) {
  const series = known.get(name);
  if (!series || !Number.isFinite(t)) return undefined;
  let low = 0, high = series.t.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (series.t[middle] <= t) low = middle + 1; else high = middle;
  }
  return low > 0 ? series.v[low - 1] ?? undefined : undefined;
}

/// {count, min, mean, max} of the samples in [from, to]; null where there are none. Of buckets their own ends count.
export function statistics(name, from, to) {
  const series = known.get(name);
  let count = 0, sum = 0, min = Infinity, max = -Infinity;
  for (let i = 0; i < (series?.t.length ?? 0); ++i) {
    const v = series.v[i];
    if (series.t[i] < from || series.t[i] > to || v === null) continue;
    ++count;
    sum += v;
    min = Math.min(min, series.low[i] ?? v);
    max = Math.max(max, series.high[i] ?? v);
  }
  return count ? {count, min, mean: sum / count, max} : null;
}
