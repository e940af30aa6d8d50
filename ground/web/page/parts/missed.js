// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Cycles that were missed, as a rate and beside what is too many: a count since the start alone says neither. Without browser and clock.

const lately_s = 60, apart_s = 1;

/// The counts of the last minute of each subsystem: `take` each status, `of` says how many of them were missed in which time.
export class MissedLately {
  #counts = new Map();

  take(t, subsystems) {
    for (const {name, missed, cycles} of subsystems) {
      if (!Number.isFinite(missed)) continue;
      const list = this.#counts.get(name) ?? [], last = list.at(-1);
      // A smaller count is another start, an earlier time another flight.
      if (last && (missed < last.missed || t < last.t)) list.length = 0;
      else if (last && t - last.t < apart_s) continue;
      list.push({t, missed, cycles});
      while (list.length > 1 && t - list[1].t >= lately_s) list.shift();
      this.#counts.set(name, list);
    }
  }

  forget() { this.#counts.clear(); }

  /// {count, cycles, seconds}, of a minute at most; null while one sample alone is known. `cycles`: those that were due meanwhile, those that ran and those that did not; NaN where nobody counts them.
  of(name, missed) {
    const list = this.#counts.get(name), first = list?.[0], last = list?.at(-1);
    return list?.length > 1 ? {count: missed - first.missed, cycles: last.cycles - first.cycles + missed - first.missed, seconds: Math.min(lately_s, last.t - first.t)} : null;
  }
}

/// How many cycles in a row of `name` its links bear: {cycles, who}, of the one that bears least; null where no link that is required bounds them.
export function borne_by(name, links) {
  const limits = links.filter((one) => one.from === name && one.required && one.age_limit_cycles > 0);
  return limits.length ? limits.map((one) => ({cycles: one.age_limit_cycles, who: one.to})).sort((a, b) => a.cycles - b.cycles)[0] : null;
}

/// In a minute, reckoned where less of one is known; "0 /min", "0.4 /min".
export const rate_of = ({count, seconds}) => count * 60 / Math.max(1, seconds);

/// "0.4 %" of those that were due, or how many where that is not known. Less than a hundredth is still something.
export function share_text({count, cycles}) {
  const share = 100 * count / cycles;
  return !(cycles > 0) ? String(count) : share < 0.01 ? 'less than 0.01 %' : `${share.toFixed(share < 1 ? 2 : 1)} %`;
}

/// "12 of 120,012 cycles missed since the start, 3 in the last 60 s. ARM is stopped when it lacks samples for 3 cycles in a row."
export function missed_words({missed, cycles, lately, borne}) {
  const number = (value) => Math.round(value).toLocaleString('en');
  return `${number(missed)} of ${number(cycles + missed)} cycles missed since the start${lately ? `, ${number(lately.count)} in the last ${lately.seconds.toFixed(0)} s` : ''}.${
    borne ? ` ${borne.who} is stopped when it lacks samples for ${borne.cycles} cycles in a row.` : ''}`;
}
