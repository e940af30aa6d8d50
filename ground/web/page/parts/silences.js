// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Where a parameter fell silent, as all of a subsystem do that is Offline: a curve across that time would be made up. Without browser.

const times_usual = 4;

/// Where no curve goes through t[first..end[: [sample before, sample behind], for longer than `held_s` apart and for much longer than is usual before or after.
/// Ranges of an archive, which stand far apart all along, are no silence, nor is where they pass into samples.
export function silences(t, first, end, held_s) {
  const found = [], apart = (i) => i > first && i < end ? t[i] - t[i - 1] : Infinity;
  for (let i = first + 1; i < end; ++i) {
    if (t[i] - t[i - 1] <= held_s) continue;
    // Of two on each side, as one of them may be another silence.
    const sides = [Math.min(apart(i - 1), apart(i - 2)), Math.min(apart(i + 1), apart(i + 2))].filter(Number.isFinite);
    if (!sides.length || apart(i) > times_usual * Math.max(...sides)) found.push([t[i - 1], t[i]]);
  }
  return found;
}

/// Which of the values of a curve no line joins to another one: null ends a curve, undefined is of another curve's times.
export function alone(values) {
  const found = [];
  let joined = false, newest = -1;
  const end = () => { if (newest >= 0 && !joined) found.push(newest); newest = -1; joined = false; };
  values.forEach((value, i) => {
    if (value === null) end();
    if (!Number.isFinite(value)) return;
    joined = newest >= 0;
    newest = i;
  });
  end();
  return found;
}
