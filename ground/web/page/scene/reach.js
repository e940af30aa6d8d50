// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The angles at which a point of a robot is at a place, by damped least squares: for a goal that is dragged. Knows nothing of the picture.

const steps = 12, difference_rad = 1e-4, most_turn_rad = 0.25, damping = 0.03;
/// So far beyond its range a joint can be dragged: that it cannot go there is to be seen.
export const beyond_rad = 0.12;

/// `place_of(angles)`: where the point is, [x, y, z] in m. `joints`: [{lower, upper, free}], those that are not free stay. Starts at `angles`.
export function reach(place_of, joints, angles, target, size_m) {
  const found = [...angles], free = joints.map(({free: is_free}, i) => is_free ? i : -1).filter((i) => i >= 0);
  for (let step = 0; step < steps; ++step) {
    const at = place_of(found), off = target.map((wanted, k) => wanted - at[k]);
    if (Math.hypot(...off) < 1e-5 * size_m) break;
    const columns = free.map((i) => {
      const turned = place_of(found.map((angle, k) => k === i ? angle + difference_rad : angle));
      return turned.map((value, k) => (value - at[k]) / difference_rad);
    });
    const pull = solved(columns, off, (damping * size_m) ** 2);
    const turns = columns.map((column) => column.reduce((sum, value, k) => sum + value * pull[k], 0));
    const least = Math.min(1, most_turn_rad / Math.max(1e-9, ...turns.map(Math.abs)));
    free.forEach((i, k) => {
      const {lower, upper} = joints[i], wanted = found[i] + least * turns[k];
      found[i] = upper > lower ? Math.max(lower - beyond_rad, Math.min(upper + beyond_rad, wanted)) : wanted;
    });
  }
  return found;
}

/// y of (J J' + d 1) y = off, three equations, by Cramer's rule; the matrix is symmetric and, for d > 0, never singular.
function solved(columns, off, d) {
  const m = [0, 1, 2].map((i) => [0, 1, 2].map((k) => columns.reduce((sum, column) => sum + column[i] * column[k], i === k ? d : 0)));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const determinant = dot(m[0], cross(m[1], m[2]));
  return [dot(off, cross(m[1], m[2])), dot(m[0], cross(off, m[2])), dot(m[0], cross(m[1], off))].map((value) => value / determinant);
}
