// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useRef, useState} from 'preact/hooks';
import {bring_up, legal_states, route, send_and_say, state_name, state_value} from '../commanding.js';
import {age_text, duration_text, number_text, rate_text, state_text, unit_text, value_text} from '../format.js';
import {html} from '../html.js';
import {Panel} from '../parts/panel.js';
import {joint_of} from '../parts/robot_file.js';
import {Splits} from '../parts/splits.js';
import {StateDiagram} from '../parts/state_diagram.js';
import {SubsystemCard, borne_missed, configuration_of, missed_lately, state_look, waits_text} from '../parts/subsystem_card.js';
import {inhibited_text} from '../stop_story.js';
import {columns, freshness, link, mission, mode_of, operator, replay, slow, status_of, subsystem_of, values} from '../store.js';

/// Brings a mode up: every step with its verdict; the first refusal stops it.
function Commissioning() {
  const able = (mission.value?.modes ?? []).filter((mode) => mode.commission?.length);
  const [name, set_name] = useState(null);
  const [steps, set_steps] = useState([]);
  const [running, set_running] = useState(false);
  const stop = useRef(false);
  const mode = able.find((one) => one.name === name) ?? able.find((one) => one.name === mission.value?.start_mode) ?? able[able.length - 1];
  if (!mode) return null;
  const run = async () => {
    stop.current = false;
    set_running(true);
    await bring_up(mode, (list) => set_steps([...list]), () => stop.current);
    set_running(false);
  };
  const failed = steps.find((step) => step.stage === 'failed');
  const done = steps.length > 0 && !running && !failed && steps.every((step) => ['completed', 'not needed'].includes(step.stage));
  const sign = {completed: '✓', 'not needed': '–', failed: '✕', waiting: '·'};
  return html`<${Panel} title="Bring a network up" hint="from any state">
    <div class="commissioning">
      <select aria-label="network" value=${mode.name} disabled=${running} data-test="commission-mode"
        onChange=${(event) => { set_name(event.currentTarget.value); set_steps([]); }}>
        ${able.map((one) => html`<option value=${one.name}>${one.name}</option>`)}</select>
      <p class="about">${mode.commission.map((member) => `${member.subsystem} ${member.configuration}`).join(', ')}</p>
      <button class="primary" data-test="commission" disabled=${running || replay.value || !operator.value || link.value.state !== 'up'} onClick=${run}>
        Bring ${mode.name} up</button>
      ${running ? html`<button class="quiet" onClick=${() => { stop.current = true; }}>stop</button>` : null}
    </div>
    ${failed ? html`<p class="permission no" data-test="commission-failed">Stopped at “${failed.text}”: ${failed.reason ?? `code ${failed.code}`}</p>` : null}
    ${steps.length ? html`<ol class="steps" data-test="steps">${steps.map((step) => html`<li class=${step.stage.replace(' ', '_')}>
      <i>${sign[step.stage] ?? '…'}</i><span>${step.text}</span><em>${step.stage === 'failed' ? step.reason ?? `code ${step.code}` :
        ['completed', 'waiting'].includes(step.stage) ? '' : step.stage}</em></li>`)}</ol>` : null}
    ${done ? html`<p class="permission yes" data-test="commissioned">✓ ${mode.name} is up</p>` : null}
  </${Panel}>`;
}

function Facts({name}) {
  const now = status_of(name) ?? {};
  const configuration = configuration_of(name), lately = missed_lately({...now, name}), borne = borne_missed(name);
  const rows = [
    ['configuration', configuration?.name ?? 'none'],
    ['sampling', rate_text(configuration?.sampling_hz)],
    ['cycles', number_text(now.cycles)],
    ['overruns', number_text(now.overruns)],
    ['missed', now.missed === undefined ? '–' : `${number_text(now.missed)} of ${number_text(now.cycles + now.missed)}`],
    ['missed, last minute', lately ? String(lately.count) : '–'],
    ...borne ? [['too many', `${borne.cycles} in a row stop ${borne.who}`]] : [],
    ['latency, largest', duration_text(now.latency_max_ns ?? NaN)],
    ['execution, mean', duration_text(now.execution_mean_ns ?? NaN)],
    ['memory', now.memory_kb ? `${(now.memory_kb / 1024).toFixed(1)} MB` : '–'],
    ['actuators', inhibited_text(now) ? `inhibited: ${inhibited_text(now)}` : 'free'],
    ['waits for', waits_text(now.waits_for) || 'nothing'],
  ];
  return html`<dl class="facts">${rows.map(([what, value]) => html`<dt>${what}</dt><dd class=${
    (what === 'actuators' && inhibited_text(now)) || (what === 'waits for' && value !== 'nothing') ? 'bad' : ''}>${value}</dd>`)}</dl>`;
}

function Bar({value, column}) {
  if (!Number.isFinite(column.min) || !Number.isFinite(column.max) || !Number.isFinite(value)) return null;
  const part = Math.max(0, Math.min(1, (value - column.min) / (column.max - column.min)));
  const outside = value < column.min || value > column.max;
  return html`<svg class=${`range ${outside ? 'bad' : part < 0.05 || part > 0.95 ? 'amber' : ''}`} viewBox="0 0 60 8" aria-hidden="true">
    <rect width="60" height="3" y="2.5" rx="1.5" /><circle cx=${3 + 54 * part} cy="4" r="3" /></svg>`;
}

const long_array = 8;

/// One entry for a number, one for a whole long array (histograms, counters): {column} or {column, elements}.
function entries_of(name) {
  const found = new Map();
  for (const column of columns.value.values()) {
    if (column.subsystem !== name) continue;
    const base = column.name.replace(/\[\d+\]$/, '');
    found.set(base, [...(found.get(base) ?? []), column]);
  }
  // Heights are of counts: an arm of many joints has its numbers.
  return [...found.entries()].flatMap(([base, list]) => list.length >= long_array && !/DOUBLE|FLOAT/.test(list[0].type) ?
    [{column: {...list[0], name: base}, elements: list}] : list.map((column) => ({column})));
}

/// Heights by the logarithm: one late cycle among a million must be seen.
function Bars({elements}) {
  const counts = elements.map((column) => Math.max(0, values.get(column.name)?.v ?? 0));
  const top = Math.log1p(Math.max(1, ...counts));
  const width = 130 / counts.length;
  return html`<svg class="bars" viewBox="0 0 130 20" role="img" aria-label=${counts.map(number_text).join(', ')}>
    ${counts.map((count, i) => html`<rect x=${i * width} width=${width - 1} y=${19 - 18 * Math.log1p(count) / top}
      height=${1 + 18 * Math.log1p(count) / top}><title>${elements[i].name}: ${number_text(count)}</title></rect>`)}</svg>`;
}

export function Values({name}) {
  slow.value;
  const own = entries_of(name);
  const half = Math.ceil(own.length / 2);
  return html`<div class="two" data-test="values">${[own.slice(0, half), own.slice(half)].map((part) => html`<table class="values"><thead><tr><th>parameter</th><th>value</th><th>unit</th><th>range</th><th class="age">age</th></tr></thead>
    <tbody>${part.map(({column, elements}) => {
      const value = values.get(column.name)?.v, joint = joint_of(column.name);
      const {age_s, stale} = freshness(elements?.[0].name ?? column.name);
      return html`<tr key=${column.name} class=${stale ? 'stale' : ''}>
        <td>${column.type === 'TEXT' ? column.name.slice(name.length + 1) : html`<a href=${`#/plots?p=${(elements ?? [column]).slice(0, 8).map((one) => encodeURIComponent(one.name)).join('+')}`} title="plot">${column.name.slice(name.length + 1)}</a>`}${joint ? html` <small>${joint.name}</small>` : null}</td>
        ${elements ? html`<td class="number" colspan="3"><${Bars} elements=${elements} /></td>` : html`<td class="number">${column.enumeration?.length ? state_text(value_text(value, column)) : value_text(value, column)}</td><td>${unit_text(column.unit)}</td>
        <td><${Bar} value=${value} column=${joint ? {min: joint.lower, max: joint.upper} : column} /></td>`}<td class="number age">${age_text(age_s)}</td></tr>`;
    })}</tbody></table>`)}</div>
    ${own.length ? null : html`<p class="empty">This subsystem tells no housekeeping.</p>`}`;
}

function Detail({name}) {
  slow.value;
  const subsystem = subsystem_of(name);
  const state = state_name(status_of(name)?.state);
  const locked = Boolean(replay.value) || !operator.value;
  const set_state = (to) => send_and_say(name, 'SET_STATE', {STATE: state_value(to)});
  const may_configure = state === 'PreOperational' && !locked;
  return html`<div class="detail">
    <${Panel} title=${name} hint=${subsystem.description ?? `APID ${subsystem.id}`} area="diagram">
      <div class="now_state">is <b class=${`state ${state_look(state)}`}>${state_text(state)}</b> <small>in mode ${mode_of.value.name}</small></div>
      <${StateDiagram} state=${state} locked=${locked} on_choose=${set_state} />
      <div class="next">${locked ? html`<small>commands are locked</small>` : html`<small>next:</small>`}
        ${legal_states(state).map((to) => html`<button class="quiet" disabled=${locked} data-test=${`go-${to}`} onClick=${() => set_state(to)}
          title=${`passes ${route(state, to).map(state_text).join(', ')}`}>${state_text(to)}</button>`)}</div>
    </${Panel}>
    <${Panel} title="Now" area="facts"><${Facts} name=${name} />
      <h3>Configuration</h3><div class="next">${subsystem.configurations.map((one) => html`<button disabled=${!may_configure} data-test=${`configure-${one.name}`}
        class=${`quiet ${configuration_of(name)?.name === one.name ? 'on' : ''}`} onClick=${() => send_and_say(name, 'CONFIGURE', {CONFIGURATION: one.id})}>
        ${one.name} <small>${rate_text(one.sampling_hz)}</small></button>`)}</div>
      ${may_configure ? null : html`<p class="about">Another configuration is taken in Pre-Operational only.</p>`}
      <h3>Telecommands</h3><div class="next">${(subsystem.functions ?? []).map((one) => html`<a class="chip" href=${`#/commands/${name}/${one.name}`}>${one.name}</a>`)}</div>
    </${Panel}>
    <${Panel} title="Housekeeping" hint="click a name to plot it" area="values"><${Values} name=${name} /></${Panel}>
  </div>`;
}

export function Subsystems({rest}) {
  const list = mission.value?.subsystems ?? [];
  const chosen = list.find((one) => one.name === rest[0] || String(one.id) === rest[0]) ?? list.find((one) => one.id >= 10) ?? list[0];
  return html`<main class="subsystems"><${Splits} name="subsystems" rows=${false} />
    <div class="column">
      <${Panel} title="Subsystems">${list.map((one) => html`<${SubsystemCard} key=${one.name} name=${one.name} chosen=${one === chosen} />`)}</${Panel}>
      <${Commissioning} />
    </div>
    ${chosen ? html`<${Detail} key=${chosen.name} name=${chosen.name} />` : null}
  </main>`;
}
