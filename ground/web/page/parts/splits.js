// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Borders between the panels of a view, to be dragged, or moved by the arrow keys; a double click brings all of that direction back. The browser remembers them for each view.
import {useLayoutEffect, useRef, useState} from 'preact/hooks';
import {html} from '../html.js';
import {extent_of, least_px, moved, remembered, template_of} from './splits_reckoned.js';

const key_px = 16;
const property = {columns: 'gridTemplateColumns', rows: 'gridTemplateRows'};
const stored = (name, way) => `hirosco-split-${name}-${way}`;

/// Sizes of the tracks as they are; empty where the view is no grid (a narrow window).
function tracks_of(grid, way) {
  const style = getComputedStyle(grid);
  return style.display === 'grid' ? style[property[way]].split(' ').map(Number.parseFloat).filter(Number.isFinite) : [];
}

/// As the view has them by itself in this window, then as they were dragged.
function apply(grid, name, way) {
  grid.style[property[way]] = '';
  const kept = remembered(localStorage.getItem(stored(name, way)), tracks_of(grid, way).length);
  if (kept) grid.style[property[way]] = template_of(kept, least_px[way]);
}

function borders_of(grid, way) {
  const tracks = tracks_of(grid, way), around = grid.getBoundingClientRect(), style = getComputedStyle(grid), gap = Number.parseFloat(style[way === 'columns' ? 'columnGap' : 'rowGap']) || 0;
  const boxes = [...grid.children].filter((child) => !child.classList.contains('splits')).map((child) => child.getBoundingClientRect()).map((box) => way === 'columns' ?
    {end: box.right - around.left, from: box.top - around.top, to: box.bottom - around.top} : {end: box.bottom - around.top, from: box.left - around.left, to: box.right - around.left});
  let at = Number.parseFloat(way === 'columns' ? style.paddingLeft : style.paddingTop) || 0;
  return tracks.slice(0, -1).flatMap((size, i) => {
    at += size;
    const along = extent_of(boxes, at, gap / 2);
    const border = along && {way, i, at: at + gap / 2, along, share: Math.round(100 * size / (size + tracks[i + 1]))};
    at += gap;
    return border ? [border] : [];
  });
}

/// The first child of a grid of panels; `rows`: whether those are to be moved, too.
export function Splits({name, rows = true}) {
  const node = useRef(null), drag = useRef(null);
  const [borders, set_borders] = useState([]);
  const ways = rows ? ['columns', 'rows'] : ['columns'];
  const grid = () => node.current.parentElement;
  const measure = () => set_borders(ways.flatMap((way) => borders_of(grid(), way)));
  useLayoutEffect(() => {
    const observer = new ResizeObserver(() => {
      for (const way of ways) apply(grid(), name, way);
      measure();
    });
    observer.observe(grid());
    return () => observer.disconnect();
  }, []);
  const set = (way, tracks) => {
    grid().style[property[way]] = template_of(tracks, least_px[way]);
    localStorage.setItem(stored(name, way), JSON.stringify(tracks.map((size) => Math.round(size))));
    measure();
  };
  const reset = (way) => {
    localStorage.removeItem(stored(name, way));
    apply(grid(), name, way);
    measure();
  };
  const place = (event, way) => way === 'columns' ? event.clientX : event.clientY;
  const press = ({way, i}) => (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    event.currentTarget.focus();
    event.currentTarget.setPointerCapture(event.pointerId);
    drag.current = {way, i, from: place(event, way), tracks: tracks_of(grid(), way)};
  };
  const move = (event) => {
    const held = drag.current;
    if (held) set(held.way, moved(held.tracks, held.i, place(event, held.way) - held.from, least_px[held.way]));
  };
  const key = ({way, i}) => (event) => {
    const by = {ArrowLeft: ['columns', -1], ArrowRight: ['columns', 1], ArrowUp: ['rows', -1], ArrowDown: ['rows', 1]}[event.key];
    if (event.key === 'Home') reset(way);
    else if (by?.[0] === way) set(way, moved(tracks_of(grid(), way), i, by[1] * key_px, least_px[way]));
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  const end = () => { drag.current = null; };
  return html`<div class="splits" ref=${node}>${borders.map((one) => html`<div key=${`${one.way}${one.i}`} class=${`split ${one.way}`} role="separator" tabindex="0" data-test=${`split-${one.way}-${one.i}`}
    aria-orientation=${one.way === 'columns' ? 'vertical' : 'horizontal'} aria-label=${`border of ${one.way} ${one.i + 1} and ${one.i + 2}`} aria-valuenow=${one.share} aria-valuemin="0" aria-valuemax="100"
    title="drag it; double click: as at first" style=${one.way === 'columns' ? {left: `${one.at}px`, top: `${one.along[0]}px`, height: `${one.along[1] - one.along[0]}px`} : {top: `${one.at}px`, left: `${one.along[0]}px`, width: `${one.along[1] - one.along[0]}px`}}
    onPointerDown=${press(one)} onPointerMove=${move} onPointerUp=${end} onPointerCancel=${end} onDblClick=${() => reset(one.way)} onKeyDown=${key(one)} />`)}</div>`;
}
