// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Where one looks in all plots at once: the time under the mouse, and up to two that a click has pinned.
import {signal} from '@preact/signals';

export const cursor_t = signal(null);
export const pins = signal([]);

/// A click pins, a second one pins the other end, a third one begins anew.
export function pin(t) {
  pins.value = pins.value.length === 2 ? [t] : [...pins.value, t].sort((a, b) => a - b);
}
export const unpin = () => { pins.value = []; };
/// One cursor there, whatever was pinned before.
export const put = (t) => { pins.value = [t]; };

/// Counts how often somebody wanted to see all again: every plot of the view shows what it did before it was zoomed.
export const whole = signal(0);
export function show_all() {
  unpin();
  ++whole.value;
}

let wanted = null, waiting = 0;
/// At most once for each frame: a mouse tells more often.
export function look_at(t) {
  wanted = t;
  waiting ||= requestAnimationFrame(() => {
    waiting = 0;
    cursor_t.value = wanted;
  });
}
