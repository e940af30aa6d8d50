// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A mouse or gamepad leads the hand at the simulated handle: it says where it is wanted as often as it moves, and the hand goes after
// it in a path of its own, as fast as is good and giving way to what it feels (docs/adr/0030). No leap of a mouse becomes one of the robot.

/// The fault line that leads the hand to these angles of the handle.
export const target_line = ([first, second]) => `hand target ${first.toFixed(4)} ${second.toFixed(4)}`;

/// Both angles within what the handle can do.
export const within_range = (hand, angles) =>
  angles.map((angle) => Math.max(-hand.handle_range_rad, Math.min(hand.handle_range_rad, angle)));

/// Abscissa of the contour's surface at an ordinate.
export function surface_x_m(contour, y) {
  const across = y - contour.bump_y_m;
  if (Math.abs(across) >= contour.bump_half_width_m) return contour.rail_x_m;
  return contour.rail_x_m - contour.bump_height_m / 2 * (1 + Math.cos(Math.PI * across / contour.bump_half_width_m));
}

const press_m = 0.010;

/// Where a fingertip is wanted that may press on the contour, but not go through it: 10 mm behind its surface at most.
export const before_wall = (contour, [x, y]) =>
  [contour ? Math.min(x, surface_x_m(contour, y) - contour.finger_radius_m + press_m) : x, y];
