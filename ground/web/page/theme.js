// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Dark, or light for projectors and bright rooms; kept for the next visit.
import {effect, signal} from '@preact/signals';

const kept = 'hirosco-theme';
const asked = /[#&?]theme=(light|dark)\b/.exec(location.hash)?.[1];
export const theme = signal(asked ?? localStorage.getItem(kept) ?? 'dark');
effect(() => {
  if (theme.value === 'light') document.documentElement.dataset.theme = 'light';
  else delete document.documentElement.dataset.theme;
});
export function switch_theme() {
  theme.value = theme.value === 'light' ? 'dark' : 'light';
  localStorage.setItem(kept, theme.value);
}

/// A colour of styles/tokens.css, for what is drawn on a canvas.
let read_for = '', colours = {};
export function colour(name) {
  if (read_for !== theme.value) {
    read_for = theme.value;
    colours = {};
  }
  return colours[name] ??= getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
