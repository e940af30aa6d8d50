// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Numbers, times and states in words. Everything here ends up in text nodes only.

/// On-board time counts from 1958-01-01 TAI (PUS-C, CUC); missions on virtual time begin small.
const epoch_ms = Date.UTC(1958, 0, 1);
const calendar_from_s = 1e9;

export function clock_text(t, digits = 1) {
  if (!Number.isFinite(t)) return '--:--:--';
  if (t < calendar_from_s) return `T+${t.toFixed(digits)} s`;
  const unit = 10 ** digits;
  const rounded = Math.floor(t * unit) / unit;
  const date = new Date(epoch_ms + Math.floor(rounded) * 1000);
  const fraction = digits > 0 ? (rounded - Math.floor(rounded)).toFixed(digits).slice(1) : '';
  return date.toISOString().slice(11, 19) + fraction;
}

export function date_text(t) {
  return t >= calendar_from_s ? new Date(epoch_ms + t * 1000).toISOString().slice(0, 10) : '';
}

/// On board nobody counts leap seconds: since 2017 its clock is as much ahead of UTC.
const tai_minus_utc_s = 37;
/// "2026-11-24T13:20:47.123Z"; empty where missions on virtual time begin.
export const iso_text = (t) => t >= calendar_from_s ? new Date(epoch_ms + (t - tai_minus_utc_s) * 1000).toISOString() : '';

/// To the browser's own Date seconds, for axis labels.
export const axis_seconds = (t) => t >= calendar_from_s ? t + epoch_ms / 1000 : t;

/// Smaller ones are the rounding of a computation.
const least_shown = 1e-9;
export function number_text(value) {
  if (typeof value === 'string') return value;
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (value === null || value === undefined) return '–';
  if (Number.isNaN(value)) return 'NaN';
  if (!Number.isFinite(value)) return value > 0 ? '+∞' : '−∞';
  if (Number.isInteger(value) && Math.abs(value) < 1e9) return String(value).replace('-', '−');
  const size = Math.abs(value);
  if (size < least_shown) return '0.0000';
  const text = size >= 1e6 || (size < 1e-4 && size > 0) ? value.toExponential(size >= 1e6 ? 3 : 1) :
    value.toFixed(size >= 1000 ? 1 : size >= 100 ? 2 : size >= 10 ? 3 : 4);
  return text.replace('-', '−');
}

/// Digits after the point by the unit: a number that changes keeps its width, and what is below the resolution of its parameter is 0.
const digits_of_unit = {rad: 3, deg: 2, mm: 1, m: 4, N: 1, 'N m': 2, Nm: 2, 'N m s': 3, 'rad/s': 3, s: 3, ms: 1, us: 1, 'µs': 1, degC: 1, 'rad|m': 4, 'rad/s|m/s': 3, 'N m|N': 2, W: 1, V: 2, A: 2, '%': 1, Hz: 1};
export function quantity_text(value, unit) {
  const digits = digits_of_unit[unit];
  if (typeof value !== 'number' || !Number.isFinite(value) || digits === undefined || Math.abs(value) >= 1e6) return number_text(value);
  return fixed_text(value, digits);
}
export const fixed_text = (value, digits) => Number.isFinite(value) ? value.toFixed(digits).replace(/^-(0(?:\.0*)?)$/, '$1').replace('-', '−') : '–';

/// Without the zeros that a table of changing numbers keeps.
export const brief_text = (value) => number_text(value).replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, '');

/// Labels of an axis, all with the digits of its step: −0.80 below −0.75.
export function ticks_text(splits) {
  const known = splits.filter(Number.isFinite), step = known.length > 1 ? String(+(known[1] - known[0]).toPrecision(3)) : 'e';
  if (step.includes('e') || known.some((value) => Math.abs(value) >= 1e6)) return splits.map((value) => value === null ? '' : brief_text(+value.toPrecision(6)));
  const digits = step.split('.')[1]?.length ?? 0;
  return splits.map((value) => value === null ? '' : fixed_text(value, digits));
}

export const value_text = (value, column) => typeof value === 'boolean' ? (value ? 'on' : 'off') :
  column?.enumeration?.find((entry) => entry.value === value)?.name ?? number_text(value);

export function age_text(age_s) {
  if (!Number.isFinite(age_s)) return 'never';
  if (age_s < 0.95) return `${Math.max(0, age_s).toFixed(1)} s`;
  if (age_s < 100) return `${age_s.toFixed(0)} s`;
  if (age_s < 6000) return `${(age_s / 60).toFixed(0)} min`;
  if (age_s > 1e8) return 'long ago';
  return `${(age_s / 3600).toFixed(0)} h`;
}

export function duration_text(ns) {
  if (!Number.isFinite(ns)) return '–';
  if (ns < 1000) return `${ns.toFixed(0)} ns`;
  if (ns < 1e6) return `${(ns / 1000).toFixed(ns < 1e4 ? 1 : 0)} µs`;
  return `${(ns / 1e6).toFixed(1)} ms`;
}

export function rate_text(hz) {
  if (!Number.isFinite(hz)) return '–';
  return hz >= 1000 ? `${+(hz / 1000).toFixed(2)} kHz` : `${+hz.toFixed(hz < 10 ? 1 : 0)} Hz`;
}

/// "SafeOperational" -> "Safe-Operational", as the paper writes the states.
export const state_text = (state) => (state === null ? 'not running' : state ?? 'unknown').replace(/([a-z])([A-Z])/g, '$1-$2');

export const unit_text = (unit) => (unit ?? '').replace('degC', '°C').replaceAll(' ', '·').replace(/^us$/, 'µs');

export const hex_text = (octets) => (octets ?? '').match(/.{1,2}/g)?.join(' ').toUpperCase() ?? '';

export const stage_text = {
  sent: 'sent', accepted: 'accepted', started: 'started', progress: 'progress', completed: 'completed', failed: 'failed',
};

/// What the flight software says as NAME=VALUE, in words: who for its number, and no jargon of programs.
const jargon = {'hung up': 'connection closed'};
export function in_words(text, name_of) {
  return text.replaceAll(/\b[A-Z][A-Z0-9_]*=/g, (marker) => `${marker.slice(0, -1).toLowerCase().replaceAll('_', ' ')} `)
      .replaceAll(/\bapid (\d+)\b/g, (whole, apid) => name_of(Number(apid)) ?? whole).replaceAll(/\breason (hung up)\b/g, (_, word) => jargon[word]);
}
