// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Whether a text is a value of an argument, by its type and range.
import {brief_text, unit_text} from '../format.js';

const integer_ranges = {UINT8: [0, 255], UINT16: [0, 65535], UINT32: [0, 4294967295], INT8: [-128, 127], INT16: [-32768, 32767],
  INT32: [-2147483648, 2147483647], UINT64: [0n, 2n ** 64n - 1n], INT64: [-(2n ** 63n), 2n ** 63n - 1n]};

/// A Number does not hold them all: they are a BigInt here, and on their way to the station a text where a Number would round.
const is_wide = (argument) => argument.type === 'UINT64' || argument.type === 'INT64';
const sent_whole = (value) => value >= Number.MIN_SAFE_INTEGER && value <= Number.MAX_SAFE_INTEGER ? Number(value) : String(value);

export function range_of(argument) {
  const [low, high] = integer_ranges[argument.type] ?? [-Infinity, Infinity];
  const limit = (given) => is_wide(argument) ? BigInt(given) : given;
  const least = limit(argument.min ?? low), most = limit(argument.max ?? high);
  return [least > low ? least : low, most < high ? most : high];
}

export const range_text = (argument) => {
  const [low, high] = range_of(argument);
  if (low === -Infinity && high === Infinity) return '';
  const brief = (value) => typeof value === 'bigint' ? String(value) : Math.abs(value) === Infinity ? '' : brief_text(value);
  return `${brief(low)} … ${brief(high)}`;
};

/// {value} or {error}: what was typed, by the argument's type and range; arrays as values with blanks between them, text as it is.
export function judged(argument, text) {
  if (argument.type === 'TEXT') {
    const octets = new TextEncoder().encode(text ?? '').length;
    return octets <= argument.octets ? {value: String(text ?? '')} : {error: `${octets} octets, at most ${argument.octets}`};
  }
  if ((argument.count ?? 1) <= 1) return judged_one(argument, text);
  const words = String(text ?? '').trim().split(/[\s;]+/).filter(Boolean);
  if (words.length !== argument.count) return {error: `needs ${argument.count} values with blanks between them`};
  const results = words.map((word) => judged_one(argument, word));
  return results.find((result) => result.error) ?? {value: results.map((result) => result.value)};
}

function judged_one(argument, text) {
  const words = String(text ?? '').trim().replace('−', '-').replace(',', '.');
  if (words === '') return {error: 'needs a value'};
  const named = argument.enumeration?.find((one) => one.name.toLowerCase() === words.toLowerCase());
  if (named) return {value: named.value};
  if (!/^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$/.test(words)) return {error: 'not a number'};
  const digits = /^[+-]?\d+$/.test(words);
  if (is_wide(argument) && !digits) return {error: 'a whole number'};
  const value = is_wide(argument) ? BigInt(words.replace('+', '')) : Number(words);
  if (argument.type in integer_ranges && !is_wide(argument) && !Number.isInteger(value)) return {error: 'a whole number'};
  const [low, high] = range_of(argument);
  if (!(value >= low && value <= high)) return {error: `outside ${range_text(argument)} ${unit_text(argument.unit)}`.trim()};
  return {value: is_wide(argument) ? sent_whole(value) : value};
}
