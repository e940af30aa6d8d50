// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A mouse or gamepad as the hand at the simulated joystick. Everything goes as `hand cartesian`, which begins where the hand is and
// moves smoothly: a mouse that leaps must not make the robot leap into its torque limit.
const shortest_s = 0.15;
const fastest_tip_m_s = 0.2;

/// The fault line that takes the hand to (dx, dy) from home, from the offset where it is about now.
export function hand_line([dx, dy], [from_x, from_y] = [0, 0], least_s = shortest_s) {
  const span_s = Math.max(least_s, Math.hypot(dx - from_x, dy - from_y) / fastest_tip_m_s);
  return `hand cartesian ${dx.toFixed(4)} ${dy.toFixed(4)} ${span_s.toFixed(3)}`;
}

/// Tip offsets of handle angles, as the operator's hand turns them (the Jacobian at home).
export const offset_of_angles = (hand, [first, second]) =>
  hand.home_jacobian_m_per_rad.map((row) => row[0] * first + row[1] * second);
