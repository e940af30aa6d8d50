// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The links in use, small: who is joined with whom, and how old a sample is when it is used, of one period of the consumer.
import {state_name} from '../commanding.js';
import {duration_text, number_text, rate_text} from '../format.js';
import {html} from '../html.js';
import {mission, slow, status_of} from '../store.js';
import {hovered, is_wanted, live_link} from './link_graph.js';
import {is_known, state_look} from './subsystem_card.js';

const width = 256, box_height = 26, row_height = 56;

const in_use = () => (mission.value?.links ?? []).filter((link) => is_wanted(link) || live_link(link.id).up);

/// Two in a row, those that are linked side by side.
function rows_of(names, links) {
  const linked = new Set(links.flatMap((link) => [link.from, link.to]));
  const sorted = [...names.filter((name) => !linked.has(name)), ...(names.filter((name) => !linked.has(name)).length % 2 ? [null] : []), ...names.filter((name) => linked.has(name))];
  return Array.from({length: Math.ceil(sorted.length / 2)}, (_, i) => sorted.slice(2 * i, 2 * i + 2));
}

function Boxes({names, links}) {
  const rows = rows_of(names, links), box = 112, places = new Map();
  rows.forEach((row, j) => row.forEach((name, i) => name && places.set(name, [i ? width - box / 2 - 1 : box / 2 + 1, j * row_height + box_height / 2 + 1])));
  const lane = new Map();
  return html`<svg class="links small" viewBox=${`0 0 ${width} ${rows.length * row_height - row_height + box_height + 2}`} role="group" aria-label="links in use">
    <defs>${['good', 'bad', 'off', 'stale'].map((look) => html`<marker id=${`small_${look}`} class=${look} viewBox="0 0 8 8" refX="7" refY="4" markerWidth="6" markerHeight="6" orient="auto"><path d="M0 0L8 4L0 8z" /></marker>`)}</defs>
    ${links.map((link) => {
      const [x1, y1] = places.get(link.from), [x2, y2] = places.get(link.to);
      const pair = [link.from, link.to].sort().join(), at = lane.get(pair) ?? 0;
      lane.set(pair, at + 1);
      const shift = at % 2 ? 5 * (1 + (at >> 1)) : -5 * (1 + (at >> 1));
      const up = live_link(link.id).up === true, look = !is_known() ? 'stale' : up ? 'good' : is_wanted(link) ? 'bad' : 'off';
      const level = y1 === y2, way = Math.sign(level ? x2 - x1 : y2 - y1);
      const path = level ? `M${x1 + way * (box / 2 + 2)} ${y1 + shift}L${x2 - way * (box / 2 + 2)} ${y2 + shift}` : `M${x1 + shift} ${y1 + way * (box_height / 2 + 2)}L${x2 + shift} ${y2 - way * (box_height / 2 + 2)}`;
      return html`<g class=${`edge ${look}`}><path d=${path} marker-end=${`url(#small_${look})`} /></g>`;
    })}
    ${[...places].map(([name, [x, y]]) => html`<a href=${`#/subsystems/${name}`} class=${`node ${is_known() ? state_look(state_name(status_of(name)?.state)) : ''}`}
      onPointerEnter=${() => { hovered.value = name; }} onPointerLeave=${() => { hovered.value = null; }}>
      <rect x=${x - box / 2} y=${y - box_height / 2} width=${box} height=${box_height} rx="5" /><text x=${x} y=${y + 4} textLength=${name.length > 15 ? box - 8 : undefined}
        lengthAdjust="spacingAndGlyphs" font-size="11">${name.slice(0, 24)}</text></a>`)}
  </svg>`;
}

function Row({link}) {
  const now = live_link(link.id), up = now.up === true;
  const rate_hz = now.rate_hz ?? link.rate_hz, period_ns = 1e9 / rate_hz;
  const part = up && Number.isFinite(now.latency_mean_ns) ? Math.max(0, Math.min(1, now.latency_mean_ns / period_ns)) : 0;
  return html`<div class=${`link_row ${is_known() ? '' : 'stale'}`}><div class="row"><b title=${link.provides}>${link.provides ?? link.name ?? `link ${link.id}`}</b>
      <span class=${up ? '' : 'down'}>${up ? duration_text(now.latency_mean_ns ?? NaN) : is_wanted(link) ? 'down' : 'idle'}</span></div>
    <svg class="budget" viewBox="0 0 100 4" preserveAspectRatio="none" aria-hidden="true"><rect class="all" width="100" height="4" /><rect class="used" width=${100 * part} height="4" /></svg>
    <div class="row second"><small>${link.from} → ${link.to}</small><small>${up ? `${rate_text(rate_hz)}, lost ${number_text(now.lost)}` : ''}</small></div></div>`;
}

export const links_hint = () => {
  const all = mission.value?.links?.length ?? 0, wanted = in_use(), down = wanted.filter((link) => live_link(link.id).up !== true).length;
  return !all ? 'none' : down ? `${wanted.length} required, ${down === wanted.length ? (down > 1 ? 'all down' : 'down') : `${down} down`}` : `${wanted.length} of ${all} in use`;
};

export function LinkRows() {
  slow.value;
  const links = in_use();
  return html`<${Boxes} names=${(mission.value?.subsystems ?? []).map((one) => one.name)} links=${links} />
    ${links.map((link) => html`<${Row} key=${link.id} link=${link} />`)}
    ${links.length ? html`<p class="hint_line">bar: age when used, of one period</p>` : html`<p class="hint_line">no real-time link in this mode</p>`}`;
}
