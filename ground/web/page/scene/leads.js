// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Thin lines from numbers to what they measure. `add()` hands out what puts one to its two ends, [x, y, x, y] in px, or to null: there is none.

const space = 'http://www.w3.org/2000/svg';

/// Above the picture, in an <svg>.
export const leads_above = (svg) => ({add() {
  const line = document.createElementNS(space, 'line');
  svg.append(line);
  let seen = '';
  return (ends) => {
    const wanted = ends ? 'visible' : 'hidden';
    if (seen !== wanted) line.setAttribute('visibility', seen = wanted);
    ends?.forEach((value, i) => line.setAttribute(['x1', 'y1', 'x2', 'y2'][i], value.toFixed(1)));
  };
}});

/// In the picture itself, where a processor draws it: lines above it would be laid out and painted for each. `all()` are those that there are.
export function leads_within() {
  const ends_of = [];
  return {add() {
    const i = ends_of.push(null) - 1;
    return (ends) => { ends_of[i] = ends; };
  }, all: () => ends_of.filter(Boolean)};
}
