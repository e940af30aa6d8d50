// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The letters of the page: what it uses of two typefaces (SIL Open Font License 1.1), cut out at build time. The ready-made Latin cuts lack
// arrows, Greek and comparison signs, which a page of numbers needs.
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import subsetFont from 'subset-font';

const range = (from, to) => Array.from({length: to - from}, (_, i) => String.fromCodePoint(from + i)).join('');

/// Every character that a text of the page, of a descriptor or of a mission may have without falling back to another typeface.
export const characters = range(0x20, 0x7f) + range(0xa0, 0x180) +
  '→←↑↓↔↗↘≤≥≈≠−×·…–—‘’“”„µΔΩτωθφπσλ√∞°±²³⁻¹₀₁₂₃₄₅₆₇₈₉✓✕●▲■◆▾▸⏎€\u202f\u2009';

const faces = {
  inter: {file: 'inter-ui/variable/InterVariable.woff2', options: {variationAxes: {opsz: 14, wght: {min: 400, max: 700}}}, more: ''},
  mono: {file: 'jetbrains-mono/fonts/webfonts/JetBrainsMono-Regular.woff2', options: {}, more: ''},
};
export const font_names = ['inter-ui'];

/// The part of the typeface NAME that the page needs, as woff2.
export function subset(modules, name) {
  const {file, options, more} = faces[name];
  return subsetFont(readFileSync(join(modules, file)), characters + more, {targetFormat: 'woff2', ...options});
}
