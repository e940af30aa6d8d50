// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Subsystems and the real-time links between them. Few nodes: a layered layout of our own does.
import {signal} from '@preact/signals';
import {state_name} from '../commanding.js';
import {duration_text, number_text, rate_text, state_text} from '../format.js';
import {html} from '../html.js';
import {mission, mode_of, slow, status, status_of} from '../store.js';
import {is_known, state_look} from './subsystem_card.js';

const node_height = 46;
const line_height = 13;
/// The subsystem under the pointer: its network, which would fall with it, is lit.
export const hovered = signal(null);

/// Everyone who hangs on `name` over required links, in both ways: who shuts down together.
export function network_of(name) {
  const found = new Set([name]);
  const links = (mission.value?.links ?? []).filter((link) => is_wanted(link) || live_link(link.id).up);
  for (let grown = true; grown;) {
    grown = false;
    for (const link of links) {
      if (found.has(link.from) !== found.has(link.to)) {
        found.add(link.from).add(link.to);
        grown = true;
      }
    }
  }
  return found;
}

/// Nobody is linked: as many rows as it takes.
function in_rows(names, places, width, height, node_width) {
  const each = Math.max(1, Math.floor(width / (node_width + 14)));
  const rows = Math.ceil(names.length / each);
  names.forEach((name, i) => places.set(name, [width * (i % each + 0.5) / Math.min(each, names.length),
    height * (Math.floor(i / each) + 0.5) / rows]));
}

function layout(names, links, width, height, node_width) {
  const linked = names.filter((name) => links.some((link) => link.from === name || link.to === name));
  const alone = names.filter((name) => !linked.includes(name));
  const places = new Map();
  const spread = (list, y) => list.forEach((name, i) => places.set(name, [width * (i + 0.5) / list.length, y]));
  if (linked.length > 2) {
    linked.forEach((name, i) => {
      const angle = 2 * Math.PI * i / linked.length - Math.PI / 2;
      places.set(name, [width / 2 + Math.cos(angle) * (width / 2 - node_width / 2 - 12), height * 0.58 + Math.sin(angle) * height * 0.33]);
    });
  } else {
    linked.forEach((name, i) => places.set(name, [node_width / 2 + 8 + (width - node_width - 16) * i, height * 0.66]));
  }
  if (linked.length > 2) alone.forEach((name, i) => places.set(name, [node_width / 2 + 8, node_height / 2 + 8 + i * (node_height + 10)]));
  else if (linked.length) spread(alone, height * 0.18);
  else in_rows(alone, places, width, height, node_width);
  return places;
}

/// Whether the present mode wants this link; a mode that says nothing of links wants those that are required.
export function is_wanted(link) {
  const established = mode_of.value.establish;
  return link.required !== false && (Array.isArray(established) ? established.includes(link.id) : true);
}

export const live_link = (id) => status.value?.links?.find((one) => one.id === id) ?? {};

/// How the link does, in lines: one in the small graph.
function facts_of(link, now, brief) {
  if (now.up !== true) return is_wanted(link) ? ['required, down'] : brief ? [] : ['idle'];
  const rate = rate_text(now.rate_hz ?? link.rate_hz), latency = duration_text(now.latency_mean_ns ?? NaN), lost = `lost ${number_text(now.lost)}`;
  if (brief) return [`${rate} · ${latency} · ${lost}`];
  return [`${rate} · age ${Number.isFinite(now.age_cycles) ? now.age_cycles.toFixed(1) : '–'} cycles`, `latency ${latency} · ${lost}`];
}

/// Where a line from the middle of a box towards `to` leaves it, and a little further.
function border([x, y], to, node_width) {
  const dx = to[0] - x, dy = to[1] - y;
  const part = Math.min((node_width / 2 + 4) / Math.abs(dx || 1e-9), (node_height / 2 + 4) / Math.abs(dy || 1e-9));
  return [x + dx * part, y + dy * part];
}

function Edge({link, places, beside, node_width, brief}) {
  const now = live_link(link.id);
  const [x1, y1] = places.get(link.from), [x2, y2] = places.get(link.to);
  const length = Math.hypot(x2 - x1, y2 - y1) || 1;
  const nx = -(y2 - y1) / length, ny = (x2 - x1) / length;
  // Ways there and back, and several of the same way, lie beside each other.
  const bend = beside * 44;
  const middle = [(x1 + x2) / 2 + nx * bend, (y1 + y2) / 2 + ny * bend];
  const a = border([x1, y1], middle, node_width), b = border([x2, y2], middle, node_width);
  const facts = facts_of(link, now, brief);
  // The words outside of the curve: beside a steep one, above or below a flat one.
  const top = [(a[0] + b[0]) / 4 + middle[0] / 2, (a[1] + b[1]) / 4 + middle[1] / 2];
  const steep = Math.abs(nx) > 0.4;
  const anchor = !steep ? 'middle' : nx > 0 ? 'start' : 'end';
  const label = [top[0] + (steep ? Math.sign(nx) * 8 : 0),
    top[1] + (steep ? -facts.length * line_height / 2 + 4 : ny >= 0 ? 16 : -8 - facts.length * line_height)];
  const up = now.up === true;
  const look = !is_known() ? 'stale' : up ? 'good' : is_wanted(link) ? 'bad' : 'off';
  const lit = hovered.value && network_of(hovered.value).has(link.from);
  return html`<g class=${`edge ${look} ${lit ? 'lit' : ''}`}>
    <path d=${`M${a} Q${middle} ${b}`} marker-end=${`url(#to_${look})`} />
    <text class=${anchor} x=${label[0]} y=${label[1]}>${link.provides ?? link.name ?? `link ${link.id}`}</text>
    ${facts.map((line, i) => html`<text class=${`facts ${anchor}`} x=${label[0]} y=${label[1] + (i + 1) * line_height}>${line}</text>`)}
  </g>`;
}

function beside(link, links) {
  const back = links.some((other) => other.from === link.to && other.to === link.from);
  const same = links.filter((other) => other.from === link.from && other.to === link.to);
  return (back ? 1 : 0) + same.indexOf(link) * (back ? 1.6 : 1);
}

export function LinkGraph({width = 420, height = 230, box: node_width = 150, all = false}) {
  slow.value;
  const names = (mission.value?.subsystems ?? []).map((one) => one.name);
  const links = (mission.value?.links ?? []).filter((link) => all || is_wanted(link) || live_link(link.id).up);
  const places = layout(names, links, width, height, node_width);
  const falls = hovered.value ? network_of(hovered.value) : new Set();
  return html`<svg class="links" viewBox=${`0 0 ${width} ${height}`} role="group" aria-label="real-time links">
    <defs>${['good', 'bad', 'off', 'stale'].map((look) => html`<marker id=${`to_${look}`} class=${look} viewBox="0 0 8 8" refX="7" refY="4"
      markerWidth="7" markerHeight="7" orient="auto"><path d="M0 0L8 4L0 8z" /></marker>`)}</defs>
    ${links.map((link) => html`<${Edge} key=${link.id} link=${link} places=${places} node_width=${node_width}
      beside=${beside(link, links)} brief=${!all} />`)}
    ${names.map((name) => {
      const [x, y] = places.get(name);
      const state = state_name(status_of(name)?.state);
      return html`<a href=${`#/subsystems/${name}`} class=${`node ${is_known() ? state_look(state) : ''} ${falls.has(name) && falls.size > 1 ? 'falls' : ''}`}
        onPointerEnter=${() => { hovered.value = name; }} onPointerLeave=${() => { hovered.value = null; }}>
        <rect x=${x - node_width / 2} y=${y - node_height / 2} width=${node_width} height=${node_height} rx="8" />
        <text x=${x} y=${y - 5}>${name}</text><text class="facts" x=${x} y=${y + 12}>${state_text(state)}</text></a>`;
    })}
  </svg>
  <p class="network">${hovered.value && falls.size > 1 ?
    `Required links bind ${[...falls].join(' and ')}: a high-severity event of one takes all of them down.` : ''}</p>`;
}
