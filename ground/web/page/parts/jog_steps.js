// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A telecommand that moves a tool with velocities for so long, known by its arguments, and the small steps that buttons send of it. Pure.

const is = (argument, count, unit) => (argument.count ?? 1) === count && argument.unit === unit;

/// {linear, angular, seconds}: what its arguments are called; null where it is none of that kind.
export function jog_of(action) {
  const list = action?.arguments ?? [];
  const linear = list.find((one) => is(one, 3, 'm/s')), angular = list.find((one) => is(one, 3, 'rad/s')), seconds = list.find((one) => is(one, 1, 's'));
  return list.length === 3 && linear && angular && seconds ? {linear, angular, seconds} : null;
}

/// How far a push goes: metres a second and radians a second, for so long.
export const paces = [{name: 'fine', m_s: 0.005, rad_s: 0.05, s: 0.4}, {name: 'medium', m_s: 0.02, rad_s: 0.1, s: 0.5}, {name: 'coarse', m_s: 0.05, rad_s: 0.25, s: 1}];
/// While a button is held the next push is sent so long after the one before: in its middle, so that one that comes late finds it under way.
export const renewed_after_ms = (pace) => 500 * pace.s;
export const axes = ['x', 'y', 'z'];

const within = ({min = -Infinity, max = Infinity}, value) => Math.max(min, Math.min(max, value));

/// The values of a push along (`turning`: about) an axis of the base, 0 to 2, to one side (1 or -1); within the descriptor's ranges.
export function push_of({linear, angular, seconds}, {turning, axis, side}, pace) {
  const along = (argument, speed) => axes.map((_, k) => k === axis && speed ? within(argument, side * speed) : 0);
  return {[linear.name]: along(linear, turning ? 0 : pace.m_s), [angular.name]: along(angular, turning ? pace.rad_s : 0), [seconds.name]: within(seconds, pace.s)};
}
