// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The timeline: modes, states, links, commands and events over time, from the archive. A click replays from there.
import {signal, useComputed} from '@preact/signals';
import {useEffect, useLayoutEffect, useRef, useState} from 'preact/hooks';
import {get} from '../api.js';
import {state_name} from '../commanding.js';
import {clock_text, state_text} from '../format.js';
import {html} from '../html.js';
import {commands, events, flight, mission, mode_of, newest_s, now_s, outcome_of, replay, replay_from, slow} from '../store.js';
import {fallen, stop} from '../stop_story.js';
import {is_wanted} from './link_graph.js';
import {risings} from './risings.js';
import {is_known, state_look} from './subsystem_card.js';

const refresh_ms = 2000, zoomed_ms = 120;
const shortest_span_s = 0.001, longest_span_s = 86400;
const usual_label_width = 118;
const longest_ahead_s = 30;
const shortest_s = 20, least_shown_s = 1;

/// The newest on-board time that the ground knows, also while a replay shows an older one.
export const end_of_time = signal(NaN);

const nothing = {modes: [], states: [], links: [], commands: [], events: [], gaps: [], faults: []};
/// What happened in the last `window_s`, or in those before `end`: asked again while it may change.
function useTimeline(window_s, end) {
  const [data, set_data] = useState({...nothing, from: 0, to: 0});
  useEffect(() => {
    let over = false;
    const fetch_again = async () => {
      if (!replay.peek() && Number.isFinite(now_s())) end_of_time.value = now_s();
      const to = end ?? (replay.peek() ? Math.max(end_of_time.peek() || 0, now_s() + Math.min(longest_ahead_s, window_s / 4)) : now_s());
      if (!Number.isFinite(to) || document.hidden) return;
      const from = end === null && replay.peek() ? Math.min(to - window_s, now_s() - window_s / 4) : to - window_s;
      try {
        const found = await get('/api/timeline', {from, to});
        if (!over) set_data({...nothing, ...found, from, to});
      } catch {
        // The header says that the gateway is gone; the last picture stays.
      }
    };
    // A wheel turns on: what it stops at is asked for.
    const first = end === null ? fetch_again() : setTimeout(fetch_again, zoomed_ms);
    const timer = setInterval(fetch_again, end === null ? refresh_ms : 5 * refresh_ms);
    return () => {
      over = true;
      clearTimeout(first);
      clearInterval(timer);
    };
  }, [window_s, end, replay.value === null, flight.value?.id]);
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

/// The way up of the whole craft, in milliseconds at the left, where it lies in what is shown: {from, to}; null where it does not.
const boot_px = 250, break_px = 16, longest_boot_s = 30;
function boot_of(data, from) {
  const up = data.states.filter((one) => state_name(one.state) === 'Operational').map((one) => one.t);
  const first = first_s(data);
  if (!up.length || !(first > from) || first > Math.min(...up)) return null;
  const each = new Map();
  for (const one of data.states) if (state_name(one.state) === 'Operational' && !each.has(one.subsystem)) each.set(one.subsystem, one.t);
  const end = Math.max(...[...each.values()].filter((t) => t - first < longest_boot_s));
  // Without the states on the way there is nothing to be shown of it: a station that came later, and a way up of later.
  const on_the_way = data.states.some((one) => state_name(one.state) !== 'Operational' && one.t >= first && one.t < end);
  return on_the_way && end - first < longest_boot_s && end > first ? {from: first, to: end + (end - first) * 0.05} : null;
}

/// `end` null follows the newest; `on_view({span_s, end})` hears of the wheel: with it, one looks from 1 ms to a day.
export function Lanes({window_s = 120, end = null, on_view = null, big = false, small = false}) {
  const node = useRef(null);
  const [width, set_width] = useState(900);
  const [hint, set_hint] = useState(null);
  const data = useTimeline(window_s, end);
  // Drawn again when the end has gone on by a point: a long time goes slowly.
  const point_s = useRef(0);
  useComputed(() => (slow.value, Math.floor(now_s() / Math.max(0.1, point_s.current)) || 0)).value;
  useLayoutEffect(() => {
    const observer = new ResizeObserver(() => set_width(Math.max(300, node.current.clientWidth)));
    observer.observe(node.current);
    return () => observer.disconnect();
  }, []);
  const now = now_s();
  const to = end ?? (replay.value ? Math.max(data.to, now) : Number.isFinite(now) ? now : data.to);
  // Before the flight began there was nothing: an empty stretch would say that nobody knows.
  const names = (mission.value?.subsystems ?? []).map((one) => one.name);
  const label_width = usual_label_width, lane_height = small ? Math.max(9, Math.min(15, 84 / (names.length + 2))) : 20, foot = small ? 18 : 22;
  // Nothing of an earlier flight, unless somebody looks there.
  const began = end === null && !replay.value ? flight.value?.from ?? -Infinity : -Infinity;
  const earliest = end !== null ? to - window_s : Math.max(began, to - Math.max(window_s, replay.value ? data.to - data.from : 0));
  const boot = small ? boot_of(data, earliest) : null;
  const from = boot ? boot.to : end !== null || window_s < shortest_s ? earliest : Math.min(to - least_shown_s, Math.max(earliest, Math.min(first_s(data) - 1, to - shortest_s)));
  const left = label_width + (boot ? boot_px + break_px : 0), plot_width = width - left - 14;
  point_s.current = end === null ? (to - from) / plot_width : 0;
  const x = (t) => boot && t < boot.to ? label_width + Math.max(0, (t - boot.from) / (boot.to - boot.from)) * boot_px :
    left + Math.max(0, Math.min(1, (t - from) / (to - from))) * plot_width;
  const time_at = (event) => {
    const at = event.clientX - node.current.getBoundingClientRect().left;
    return boot && at < left ? boot.from + (at - label_width) / boot_px * (boot.to - boot.from) : from + (at - left) / plot_width * (to - from);
  };
  const begin = boot ? boot.from : from;
  useEffect(() => {
    if (!on_view) return;
    const turn = (event) => {
      event.preventDefault();
      on_view(turned(event, time_at(event), {from, to, wide_s: end === null ? window_s : to - from, now: now_s()}));
    };
    const svg = node.current;
    svg.addEventListener('wheel', turn, {passive: false});
    return () => svg.removeEventListener('wheel', turn);
  });

  const lanes = [];
  // What nobody tells any more is not drawn on.
  const told_to = is_known() ? to : Math.min(to, newest_s());
  // A state that lasts from the start into the flight is drawn on both sides of the break.
  const parts = (span) => boot && span.from < boot.to && span.to > boot.to ? [{...span, to: boot.to - 1e-6}, {...span, from: boot.to}] : [span];
  const bars = (span, look, text) => parts(span).map((part) => bar(part, look, text));
  const inset = small ? 1 : 3;
  const bar = (span, look, text) => html`<g class=${`bar ${look}`}><rect x=${x(span.from)} y=${inset} rx=${small ? 1 : 3} height=${lane_height - 2 * inset}
    width=${Math.max(1, x(span.to) - x(span.from))}><title>${text} from ${clock_text(span.from)}</title></rect>
    ${x(span.to) - x(span.from) > text.length * 7 + 8 ? html`<text x=${x(span.from) + 6} y=${lane_height / 2 + 4}>${text}</text>` : null}</g>`;
  const current = {t: begin, mode: mode_of.value.name};
  const mode_list = data.modes.length ? data.modes : [current];
  const up = risings([...data.modes, ...data.states.map((one) => ({...one, state: state_name(one.state)}))], mission.value?.modes ?? []).filter((one) => one.t >= begin && one.t <= to);
  lanes.push({label: 'mode', body: spans(mode_list, (one) => one.mode, begin, told_to)
      .flatMap((span, i) => bars(span, `mode ${i % 2 ? 'odd' : ''}`, mission.value?.modes.find((mode) => mode.id === span.value)?.name ?? String(span.value)))});
  const up_marks = up.map((one) => html`<path class="up" transform=${`translate(${x(one.t)} ${lane_height / 2})`} d="M-4 0L-1 3L4-4"><title>${one.name} is up, ${clock_text(one.t)}</title></path>`);
  for (const name of names) {
    const own = data.states.filter((one) => one.subsystem === name);
    lanes.push({label: name, body: spans(own, (one) => state_name(one.state), begin, told_to)
        .flatMap((span) => bars(span, state_look(span.value), state_text(span.value)))});
  }
  if (big) {
    for (const link of mission.value?.links ?? []) {
      const own = data.links.filter((one) => one.id === link.id);
      lanes.push({label: `link ${link.id}`, body: spans(own, (one) => one.up, begin, told_to)
          .flatMap((span) => bars(span, span.value ? 'good' : is_wanted(link) ? 'bad' : 'off', span.value ? `${link.from} → ${link.to}` : 'down'))});
    }
  }
  const sent = replay.value ? data.commands : merged(data.commands, commands.value);
  const command_marks = sent.filter((one) => one.t >= from && one.t <= to).map((one) => html`
    <path class=${`command ${one.stages ? outcome_of(one).stage : one.stage}`} transform=${`translate(${x(one.t)} ${lane_height / 2})`} d="M-2.5-4L2.5 0L-2.5 4">
      <title>${one.subsystem} ${one.function}: ${one.stages ? outcome_of(one).stage : one.stage}</title></path>`);
  if (!small) lanes.push({label: 'commands', body: command_marks});
  const told = replay.value ? data.events : merged(data.events, events.value.slice(0, 200), (one) => `${one.t}/${one.id}/${one.subsystem}`);
  const shown = told.filter((one) => one.t >= begin && one.t <= to && !(small && one.severity === 'info'));
  const marks = shown.filter((one) => one.severity !== 'info').concat(shown.filter((one) => one.severity === 'info')).slice(0, 600);
  lanes[small ? 'unshift' : 'push']({label: 'events', body: [small ? command_marks : null, up_marks, marks.reverse().map((one) => html`<path class=${`mark ${one.severity}`}
    transform=${`translate(${x(one.t)} ${lane_height / 2})`} d=${{high: 'M-3-5h6l3 5l-3 5h-6l-3-5z', medium: 'M0-6L6 5H-6z', low: 'M-3.5-3.5h7v7h-7z'}[one.severity] ?? 'M-1.5-4h3v8h-3z'}>
    <title>${one.subsystem} ${one.name} ${clock_text(one.t)}</title></path>`)]});
  const faults = data.faults ?? [];
  if (!small && (faults.length || big)) {
    lanes.push({label: 'faults', body: faults.filter((one) => one.t >= from && !/^hand (target|hold|cartesian)/.test(one.line)).map((one) => html`
      <path class="mark fault" transform=${`translate(${x(one.t)} ${lane_height / 2})`} d="M2-6L-4 2H0L-2 6L5-2H1z"><title>${one.device} ${one.line}</title></path>`)});
  }

  const height = lanes.length * lane_height + foot;
  const ticks = time_ticks(from, to, plot_width / 110);
  return html`<div class="lanes" ref=${node} data-test="timeline">
    <svg width=${width} height=${height} onPointerMove=${(event) => set_hint(time_at(event))} onPointerLeave=${() => set_hint(null)}
      onClick=${(event) => { const at = time_at(event); if (at >= begin && at <= to) replay_from(at); }} role="img"
      aria-label="timeline; a click replays from there">
      ${ticks.map((t) => html`<g class="tick"><line x1=${x(t)} x2=${x(t)} y1="0" y2=${height - 18} /><text x=${Math.min(x(t), width - 34)} y=${height - 5}>${clock_text(t, ticks.digits)}</text></g>`)}
      ${boot ? html`<${Boot} boot=${boot} x=${x} height=${height} left=${left} />` : null}
      ${lanes.map((lane, i) => html`<g transform=${`translate(0 ${i * lane_height})`}><text class=${`label ${fallen.value.some((one) => one.subsystem === lane.label) ? 'bad' : ''}`} x="12" y=${lane_height / 2 + 4}>${lane.label.slice(0, 15)}</text>${lane.body}</g>`)}
      ${data.gaps.map((gap) => html`<rect class="gap" x=${x(gap.from)} y="0" width=${Math.max(1, x(gap.to) - x(gap.from))} height=${height - 20}>
        <title>no telemetry came</title></rect>`)}
      ${stop.value && stop.value.t > from ? html`<line class="stopped" x1=${x(stop.value.t)} x2=${x(stop.value.t)} y1="0" y2=${height - 16} />` : null}
      ${replay.value ? html`<g class="now replay"><line x1=${x(now)} x2=${x(now)} y1="0" y2=${height - 16} /></g>` :
        end !== null ? null : html`<g class="now"><line x1=${x(to)} x2=${x(to)} y1="0" y2=${height - 16} /></g>`}
      ${hint !== null && hint >= begin && hint <= to ? html`<g class="hint"><line x1=${x(hint)} x2=${x(hint)} y1="0" y2=${height - 16} />
        <text x=${Math.min(x(hint) + 6, width - 150)} y=${height - (small ? 5 : 22)}>replay from ${clock_text(hint, Math.max(1, ticks.digits))}</text></g>` : null}
    </svg></div>`;
}

function Boot({boot, x, height, left}) {
  const length_ms = 1000 * (boot.to - boot.from);
  const step_ms = [5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000].find((one) => length_ms / one <= 4) ?? 20000;
  const ticks = Array.from({length: Math.floor(length_ms / step_ms) + 1}, (_, i) => i * step_ms);
  return html`<g class="tick">${ticks.map((ms) => html`<line x1=${x(boot.from + ms / 1000)} x2=${x(boot.from + ms / 1000)} y1="0" y2=${height - 18} />
    <text x=${x(boot.from + ms / 1000) + (ms ? 0 : 12)} y=${height - 5}>${ms ? `${ms} ms` : 'start'}</text>`)}</g>
    <path class="break" d=${`M${left - 12} 2l5 11-5 11 5 11-5 11 5 11-5 11`} />`;
}

function merged(archive, fresh, key = (one) => one.id) {
  const known = new Set(fresh.map(key));
  return [...fresh, ...archive.filter((one) => !known.has(key(one)))];
}

const tick_steps = [1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800, 3600, 7200, 21600];
function time_ticks(from, to, count) {
  const step = tick_steps.find((one) => one >= (to - from) / count) ?? 43200;
  const ticks = [];
  for (let t = Math.ceil(from / step) * step; t < to; t += step) if (ticks.length < 60) ticks.push(t);
  ticks.digits = step >= 1 ? 0 : Math.ceil(-Math.log10(step) - 1e-9);
  return ticks;
}

/// What a wheel makes of a view: nearer or further about the time under the mouse, along it with Shift or a wheel that turns sideways.
/// `wide_s`: what was asked for, where a flight is shorter than that.
export function turned({deltaX, deltaY, shiftKey}, at, {from, to, wide_s, now}) {
  const span_s = to - from;
  if (shiftKey || Math.abs(deltaX) > Math.abs(deltaY)) {
    const end = to + span_s * 0.15 * Math.sign(deltaX || deltaY);
    return {span_s, end: end >= now ? null : end};
  }
  const wanted = Math.max(shortest_span_s, Math.min(longest_span_s, deltaY > 0 ? 1.4 * Math.max(span_s, wide_s) : span_s / 1.4));
  const end = at + (to - at) * wanted / span_s;
  return {span_s: wanted, end: end >= now ? null : end};
}
