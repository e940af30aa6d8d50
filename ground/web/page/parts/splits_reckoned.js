// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Sizes of the tracks of a grid, in px, when the border between two of them is dragged.

export const least_px = {columns: 200, rows: 84};

/// The tracks after the border behind track `at` went by `by_px`: what one gains the next one loses, and neither becomes smaller than `least` (or than it is, where that is less).
export function moved(tracks, at, by_px, least) {
  const [before, after] = [tracks[at], tracks[at + 1]];
  const by = Math.max(Math.min(least, before) - before, Math.min(after - Math.min(least, after), by_px));
  return tracks.map((size, i) => i === at ? before + by : i === at + 1 ? after - by : size);
}

/// For `grid-template-…`: in another window they keep their shares.
export const template_of = (tracks, least) => tracks.map((size) => `minmax(min(${least}px, ${Math.floor(size)}px), ${size.toFixed(1)}fr)`).join(' ');

/// What a browser remembers, as tracks; null where that is none, or of another number of tracks.
export function remembered(text, count) {
  let tracks = null;
  try {
    tracks = JSON.parse(text);
  } catch { /* nothing of ours */ }
  return Array.isArray(tracks) && tracks.length === count && tracks.every((size) => Number.isFinite(size) && size >= 1) ? tracks : null;
}

/// Where a border is seen: from the first to the last of `boxes` ({from, to} across, {start, end} along) that ends at it.
export function extent_of(boxes, border, slack) {
  const beside = boxes.filter((box) => Math.abs(box.end - border) <= slack);
  return beside.length ? [Math.min(...beside.map((box) => box.from)), Math.max(...beside.map((box) => box.to))] : null;
}
