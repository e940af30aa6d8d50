// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The ten states as the paper draws them (figure 4): up on the left, down on the right. Only legal next states answer a click.
import {route} from '../commanding.js';
import {state_text} from '../format.js';
import {html} from '../html.js';
import {mission} from '../store.js';
import {state_look} from './subsystem_card.js';

const width = 152, height = 40;
const places = {
  Operational: [230, 34], SafeOperational: [230, 112], ErrorOperational: [470, 112], PreOperational: [230, 190],
  PostOperational: [470, 190], HardwareInit: [230, 268], HardwareDeinit: [470, 268], SoftwareInit: [230, 346],
  SoftwareDeinit: [470, 346], Offline: [350, 418],
};
const size = {x: 640, y: 456};

/// From border to border of two boxes, a little beside the middle when there is a way back.
function path(from, to, both) {
  const [x1, y1] = places[from], [x2, y2] = places[to];
  const shift = both ? 11 : 0;
  const dx = x2 - x1, dy = y2 - y1;
  const length = Math.hypot(dx, dy);
  const side = [-dy / length * shift, dx / length * shift];
  const reach = (sign_x, sign_y) => Math.min(Math.abs(dx) > 1 ? (width / 2 + 3) / Math.abs(dx / length) : Infinity,
    Math.abs(dy) > 1 ? (height / 2 + 3) / Math.abs(dy / length) : Infinity) * (sign_x + sign_y) / 2;
  const cut = reach(1, 1);
  const ux = dx / length, uy = dy / length;
  const a = [x1 + ux * cut + side[0], y1 + uy * cut + side[1]], b = [x2 - ux * cut + side[0], y2 - uy * cut + side[1]];
  return `M${a[0].toFixed(1)} ${a[1].toFixed(1)}L${b[0].toFixed(1)} ${b[1].toFixed(1)}`;
}

export function StateDiagram({state, locked, on_choose}) {
  const edges = mission.value?.transitions ?? [];
  const has = (from, to) => edges.some((edge) => edge.from === from && edge.to === to);
  return html`<svg class="diagram" viewBox=${`0 0 ${size.x} ${size.y}`} role="group" aria-label="the ten states">
    <defs>
      <marker id="arrow" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto">
        <path d="M0 0L8 4L0 8z" /></marker>
      <marker id="arrow_next" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="6" markerHeight="6" orient="auto">
        <path d="M0 0L8 4L0 8z" /></marker>
    </defs>
    ${edges.filter((edge) => places[edge.from] && places[edge.to]).map((edge) => html`
      <path class=${`edge ${edge.kind === 'failure' ? 'failure' : ''} ${edge.from === state ? 'next' : ''}`}
        marker-end=${edge.from === state ? 'url(#arrow_next)' : 'url(#arrow)'}
        d=${path(edge.from, edge.to, has(edge.to, edge.from))} />`)}
    ${Object.entries(places).map(([name, [x, y]]) => {
      const way = route(state, name);
      const open = way && !locked;
      const press = () => open && on_choose(name);
      return html`<g class=${`node ${name === state ? `here ${state_look(name)}` : ''} ${open ? 'open' : ''}`}
        transform=${`translate(${x - width / 2} ${y - height / 2})`} role=${open ? 'button' : undefined}
        tabindex=${open ? 0 : undefined} onClick=${press} data-test=${`state-${name}`}
        onKeyDown=${(event) => ['Enter', ' '].includes(event.key) && (event.preventDefault(), press())}>
        <rect width=${width} height=${height} rx="7" />
        <text x=${width / 2} y=${height / 2 + 1}>${state_text(name)}</text>
        ${open && way.length > 1 ? html`<title>passes ${way.map(state_text).join(', ')}</title>` : null}
      </g>`;
    })}
  </svg>`;
}
