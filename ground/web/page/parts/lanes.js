// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The timeline: modes, states, links, commands and events over time, from the archive. A click replays from there.
import {signal} from '@preact/signals';
import {useEffect, useLayoutEffect, useRef, useState} from 'preact/hooks';
import {get} from '../api.js';
import {state_name} from '../commanding.js';
import {clock_text, state_text} from '../format.js';
import {html} from '../html.js';
import {commands, events, mission, mode_of, newest_s, now_s, outcome_of, replay, replay_from, slow} from '../store.js';
import {is_wanted} from './link_graph.js';
import {is_known, state_look} from './subsystem_card.js';

const refresh_ms = 2000;
const label_width = 118, lane_height = 20;
const longest_ahead_s = 30;
const shortest_s = 20;

/// The newest on-board time that the ground knows, also while a replay shows an older one.
export const end_of_time = signal(NaN);

function useTimeline(window_s) {
  const [data, set_data] = useState({modes: [], states: [], links: [], commands: [], events: [], gaps: [], from: 0, to: 0});
  useEffect(() => {
    let over = false;
    const fetch_again = async () => {
      if (!replay.peek() && Number.isFinite(now_s())) end_of_time.value = now_s();
      const to = replay.peek() ? Math.max(end_of_time.peek() || 0, now_s() + Math.min(longest_ahead_s, window_s / 4)) : now_s();
      if (!Number.isFinite(to) || document.hidden) return;
      const from = replay.peek() ? Math.min(to - window_s, now_s() - window_s / 4) : to - window_s;
      try {
        const found = await get('/api/timeline', {from, to});
        if (!over) set_data({modes: [], states: [], links: [], commands: [], events: [], gaps: [], faults: [], ...found, from, to});
      } catch {
        // The header says that the gateway is gone; the last picture stays.
      }
    };
    fetch_again();
    const timer = setInterval(fetch_again, refresh_ms);
    return () => {
      over = true;
      clearInterval(timer);
    };
  }, [window_s, replay.value === null]);
  return data;
}

/// [{from, to, text}] of what held, from the changes.
function spans(changes, value_of, from, to) {
  const sorted = [...changes].sort((a, b) => a.t - b.t);
  return sorted.map((one, i) => ({from: Math.max(from, one.t), to: Math.min(to, sorted[i + 1]?.t ?? to), value: value_of(one)}))
      .filter((span) => span.to >= from && span.from <= to && span.to > span.from);
}

/// When the first thing happened that a timeline knows of; at its left edge, or before it, where the archive goes on before it.
const first_s = (data) => Math.min(Infinity, ...['modes', 'states', 'links', 'commands', 'events'].flatMap((kind) => data[kind].map((one) => one.t)));

export function Lanes({window_s = 120, big = false}) {
  const node = useRef(null);
  const [width, set_width] = useState(900);
  const [hint, set_hint] = useState(null);
  const data = useTimeline(window_s);
  slow.value;
  useLayoutEffect(() => {
    const observer = new ResizeObserver(() => set_width(Math.max(300, node.current.clientWidth)));
    observer.observe(node.current);
    return () => observer.disconnect();
  }, []);
  const now = now_s();
  const to = replay.value ? Math.max(data.to, now) : Number.isFinite(now) ? now : data.to;
  // Before the flight began there was nothing: an empty stretch would say that nobody knows.
  const from = Math.max(to - Math.max(window_s, data.to - data.from), Math.min(first_s(data) - 1, to - shortest_s));
  const plot_width = width - label_width - 14;
  const x = (t) => label_width + Math.max(0, Math.min(1, (t - from) / (to - from))) * plot_width;
  const time_at = (event) => from + (event.clientX - node.current.getBoundingClientRect().left - label_width) / plot_width * (to - from);
  const names = (mission.value?.subsystems ?? []).map((one) => one.name);

  const lanes = [];
  // What nobody tells any more is not drawn on.
  const told_to = is_known() ? to : Math.min(to, newest_s());
  const bar = (span, look, text) => html`<g class=${`bar ${look}`}><rect x=${x(span.from)} y="3" rx="3" height=${lane_height - 6}
    width=${Math.max(1, x(span.to) - x(span.from))}><title>${text} from ${clock_text(span.from)}</title></rect>
    ${x(span.to) - x(span.from) > text.length * 7 + 8 ? html`<text x=${x(span.from) + 6} y=${lane_height / 2 + 4}>${text}</text>` : null}</g>`;
  const current = {t: from, mode: mode_of.value.name};
  const mode_list = data.modes.length ? data.modes : [current];
  lanes.push({label: 'mode', body: spans(mode_list, (one) => one.mode, from, told_to)
      .map((span, i) => bar(span, `mode ${i % 2 ? 'odd' : ''}`, mission.value?.modes.find((mode) => mode.id === span.value)?.name ?? String(span.value)))});
  for (const name of names) {
    const own = data.states.filter((one) => one.subsystem === name);
    lanes.push({label: name, body: spans(own, (one) => state_name(one.state), from, told_to)
        .map((span) => bar(span, state_look(span.value), state_text(span.value)))});
  }
  if (big) {
    for (const link of mission.value?.links ?? []) {
      const own = data.links.filter((one) => one.id === link.id);
      lanes.push({label: `link ${link.id}`, body: spans(own, (one) => one.up, from, told_to)
          .map((span) => bar(span, span.value ? 'good' : is_wanted(link) ? 'bad' : 'off', span.value ? `${link.from} → ${link.to}` : 'down'))});
    }
  }
  const sent = replay.value ? data.commands : merged(data.commands, commands.value);
  lanes.push({label: 'commands', body: sent.filter((one) => one.t >= from && one.t <= to).map((one) => html`
    <rect class=${`command ${one.stages ? outcome_of(one).stage : one.stage}`} x=${x(one.t) - 3} y="4" width="6" height=${lane_height - 8} rx="2">
      <title>${one.subsystem} ${one.function}: ${one.stages ? outcome_of(one).stage : one.stage}</title></rect>`)});
  const told = replay.value ? data.events : merged(data.events, events.value.slice(0, 200), (one) => `${one.t}/${one.id}/${one.subsystem}`);
  const shown = told.filter((one) => one.t >= from && one.t <= to);
  const marks = shown.filter((one) => one.severity !== 'info').concat(shown.filter((one) => one.severity === 'info')).slice(0, 600);
  lanes.push({label: 'events', body: marks.reverse().map((one) => html`<path class=${`mark ${one.severity}`}
    transform=${`translate(${x(one.t)} ${lane_height / 2})`} d=${{high: 'M-4-6h8v12h-8z', medium: 'M0-6L6 5H-6z', low: 'M0-5L5 0L0 5L-5 0z'}[one.severity] ?? 'M-1.5-4h3v8h-3z'}>
    <title>${one.subsystem} ${one.name} ${clock_text(one.t)}</title></path>`)});
  const faults = data.faults ?? [];
  if (faults.length || big) {
    lanes.push({label: 'faults', body: faults.filter((one) => one.t >= from && !/^hand (target|hold|cartesian)/.test(one.line)).map((one) => html`
      <path class="mark fault" transform=${`translate(${x(one.t)} ${lane_height / 2})`} d="M2-6L-4 2H0L-2 6L5-2H1z"><title>${one.device} ${one.line}</title></path>`)});
  }

  const height = lanes.length * lane_height + 22;
  const ticks = time_ticks(from, to, plot_width / 110);
  return html`<div class="lanes" ref=${node} data-test="timeline">
    <svg width=${width} height=${height} onPointerMove=${(event) => set_hint(time_at(event))} onPointerLeave=${() => set_hint(null)}
      onClick=${(event) => { const at = time_at(event); if (at >= from && at <= to) replay_from(at); }} role="img"
      aria-label="timeline; a click replays from there">
      ${ticks.map((t) => html`<g class="tick"><line x1=${x(t)} x2=${x(t)} y1="0" y2=${height - 18} /><text x=${x(t)} y=${height - 5}>${clock_text(t, 0)}</text></g>`)}
      ${lanes.map((lane, i) => html`<g transform=${`translate(0 ${i * lane_height})`}><text class="label" x="10" y=${lane_height / 2 + 4}>${lane.label}</text>${lane.body}</g>`)}
      ${data.gaps.map((gap) => html`<rect class="gap" x=${x(gap.from)} y="0" width=${Math.max(1, x(gap.to) - x(gap.from))} height=${height - 20}>
        <title>no telemetry came</title></rect>`)}
      ${replay.value ? html`<g class="now replay"><line x1=${x(now)} x2=${x(now)} y1="0" y2=${height - 16} /></g>` :
        html`<g class="now"><line x1=${x(to)} x2=${x(to)} y1="0" y2=${height - 16} /></g>`}
      ${hint !== null && hint >= from && hint <= to ? html`<g class="hint"><line x1=${x(hint)} x2=${x(hint)} y1="0" y2=${height - 16} />
        <text x=${Math.min(x(hint) + 6, width - 150)} y=${height - 22}>replay from ${clock_text(hint)}</text></g>` : null}
    </svg></div>`;
}

function merged(archive, fresh, key = (one) => one.id) {
  const known = new Set(fresh.map(key));
  return [...fresh, ...archive.filter((one) => !known.has(key(one)))];
}

function time_ticks(from, to, count) {
  const step = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600].find((one) => one >= (to - from) / count) ?? 7200;
  const ticks = [];
  for (let t = Math.ceil(from / step) * step; t < to; t += step) if (ticks.length < 60) ticks.push(t);
  return ticks;
}
