// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Samples of the parameters that are drawn: the past from the archive, then what the feed brings; the same of another flight, and what is
// reckoned of them. Shared between plots.
import {get} from './api.js';
import {is_reckoned, of_flight, reckoned} from './parts/curves.js';
import {reckon} from './parts/expression.js';
import {aligned} from './parts/rows.js';
import {thinned} from './parts/thinned.js';
import {columns, filled, flight, flights, freshness, gateway, newest_s, now_s, on_values, replay, values} from './store.js';

const most_samples = 40000;
/// A window as long as the flight that is shown.
export const whole_flight = Infinity;
/// Of another flight that is drawn beside this one.
const longest_past_s = 3600;
/// A sample of an expression's parameter holds for three of its periods, for this long at least.
const least_held_s = 2, least_flight_s = 1;
const backlog_points = 3000, flight_points = 20000;

const known = new Map();

/// What stands for a range of samples: of values that have names one that there was.
function middle_of(name) {
  const column = columns.peek().get(name);
  return column?.enumeration?.length || column?.type === 'BOOL' ? (low, high) => high : (low, high) => (low + high) / 2;
}

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
    if (this.t.length > most_samples) Object.assign(this, thinned(this, most_samples / 2, middle_of(this.name)));
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
      const between = middle_of(this.name), middle = answer.v ?? answer.min.map((low, i) => between(low, answer.max[i]));
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

/// A parameter as it was in another flight, as if that had begun when the one that is shown began: fetched once, and nothing comes to it.
class PastSeries extends Series {
  constructor(name) {
    super(name);
    [this.parameter, this.id] = of_flight(name);
  }

  push() {}

  async fetch() {
    const other = flights.value.find((one) => one.id === this.id), began = began_s();
    if (!other || !Number.isFinite(began) || this.from === began) return;
    this.from = began;
    try {
      const answer = await get('/api/history', {parameter: this.parameter, from: other.from, to: Math.min(other.to, other.from + longest_past_s), points: flight_points});
      const number = (value) => Number.isFinite(value) ? value : null, between = middle_of(this.parameter);
      this.t = answer.t.map((t) => t - other.from + began);
      this.v = (answer.v ?? answer.min.map((low, i) => between(low, answer.max[i]))).map(number);
      [this.low, this.high] = [answer.min, answer.max].map((list) => list ? list.map(number) : this.t.map(() => null));
      ++this.version;
    } catch {
      this.from = Infinity;
    }
  }
}

/// When the flight that is shown began: that of now, or the one that is replayed; undefined while nobody knows.
export function began_s() {
  const at = replay.peek()?.at;
  return at === undefined ? flight.peek()?.from : flights.peek().find((one) => one.from <= at)?.from;
}

/// [from, to] of what a plot shows: `range` where it stands still, else a window that ends now.
export function shown_span(window_s, range, to = now_s()) {
  if (range) return range;
  return window_s === whole_flight ? [Math.min(began_s() ?? to - least_flight_s, to - least_flight_s), to] : [to - window_s, to];
}

/// For how long a sample of a series holds: three of its periods, of an expression those of its slowest parameter.
function held_s(series) {
  if (series.inputs) return Math.max(...series.inputs.map(held_s), least_held_s);
  return Math.max(least_held_s, 3 * (columns.peek().get(of_flight(series.name)[0])?.period_s ?? 1));
}

/// An expression at the times of its parameters' samples.
class ReckonedSeries {
  uses = 0;
  #of = -1;
  #made = {t: [], v: [], none: []};

  constructor(name, window_s) {
    this.name = name;
    this.program = reckoned(name);
    this.inputs = this.program.inputs.map((input) => use_series(input, window_s));
  }

  get t() { return this.#now().t; }
  get v() { return this.#now().v; }
  get low() { return this.#now().none; }
  get high() { return this.#now().none; }
  fetch(from) { for (const one of this.inputs) one.fetch(from); }
  push() {}
  forget() {}
  close() { this.inputs.forEach(drop_series); }

  #now() {
    // Every change of a series counts: together they have had as many.
    let of = 0;
    for (const one of this.inputs) of += one.version;
    if (of !== this.#of) {
      this.#of = of;
      const {t, v} = reckon(this.program, this.inputs, this.inputs.map(held_s));
      this.#made = {t, v, none: t.map(() => null)};
    }
    return this.#made;
  }
}

export function use_series(name, window_s) {
  let series = known.get(name);
  if (!series) known.set(name, series = is_reckoned(name) ? new ReckonedSeries(name, window_s) : of_flight(name)[1] !== null ? new PastSeries(name) : new Series(name));
  ++series.uses;
  extend(series, window_s);
  return series;
}

export function extend(series, window_s) {
  const newest = newest_s();
  // Nothing of an earlier flight, but in a replay of it.
  const began = replay.value ? -Infinity : flight.value?.from ?? -Infinity;
  const from = window_s === whole_flight ? began_s() : Math.max(began, newest - window_s - 1);
  if (Number.isFinite(newest) && Number.isFinite(from)) series.fetch(from);
}

export function drop_series(series) {
  if (--series.uses > 0) return;
  known.delete(series.name);
  series.close?.();
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

/// The archive knows more than the page.
function fetch_all_again() {
  for (const series of known.values()) {
    const from = series.from;
    series.forget();
    if (Number.isFinite(from)) series.fetch(from);
  }
}

/// What the archive got while the page had no gateway comes from there: a line over the time between would be a lie.
let was_connected = true;
gateway.subscribe(({connected}) => {
  if (connected && !was_connected) fetch_all_again();
  was_connected = connected;
});

/// What the station had missed, and has fetched.
filled.subscribe((times) => { if (times > 0) fetch_all_again(); });

// An address may name a flight before the page knows which there are.
flights.subscribe(() => { for (const series of known.values()) if (series instanceof PastSeries) series.fetch(); });

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

/// Rows of what is drawn: none across a silence.
export const drawn_rows = (list, from, to) => aligned(list, from, to, held_s);

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

/// What a curve shows now: {v, stale}.
export function newest_of(name) {
  if (!is_reckoned(name) && of_flight(name)[1] === null) return {v: values.get(name)?.v, stale: freshness(name).stale};
  const stale = is_reckoned(name) && reckoned(name).inputs.some((input) => of_flight(input)[1] === null && freshness(input).stale);
  return {v: value_at(name, now_s()), stale};
}

/// {count, min, min_t, mean, max, max_t} of the samples in [from, to]; null where there are none. Of buckets their own ends count, at the time
/// of the bucket; of equal ones the first.
export function statistics(name, from, to) {
  const series = known.get(name);
  let count = 0, sum = 0, min = Infinity, max = -Infinity, min_t = NaN, max_t = NaN;
  for (let i = 0; i < (series?.t.length ?? 0); ++i) {
    const v = series.v[i];
    if (series.t[i] < from || series.t[i] > to || v === null) continue;
    ++count;
    sum += v;
    const low = series.low[i] ?? v, high = series.high[i] ?? v;
    if (low < min) [min, min_t] = [low, series.t[i]];
    if (high > max) [max, max_t] = [high, series.t[i]];
  }
  return count ? {count, min, min_t, mean: sum / count, max, max_t} : null;
}
