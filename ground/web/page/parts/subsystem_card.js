// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {computed} from '@preact/signals';
import {state_name, state_names} from '../commanding.js';
import {brief_text, duration_text, rate_text, state_text} from '../format.js';
import {html} from '../html.js';
import {fallen_text, inhibited_text, is_switched_off} from '../stop_story.js';
import {link, mission, now_s, replay, slow, status, status_of, subsystem_of} from '../store.js';
import {borne_by, missed_words, MissedLately, rate_of} from './missed.js';

export const state_look = (state) => ({Operational: 'good', SafeOperational: 'amber', PreOperational: 'amber',
  ErrorOperational: 'bad', PostOperational: 'amber', Offline: 'off'})[state] ?? 'busy';

/// The ten states in a row; the present one is marked, those passed on the way up are lit.
export function StateStrip({state}) {
  const at = state_names.indexOf(state);
  return html`<div class=${`strip ${state_look(state)}`} role="img" aria-label=${`state ${state_text(state)}`}>
    ${state_names.map((name, i) => html`<i title=${state_text(name)}
      class=${i === at ? 'here' : i < at && at <= 5 ? 'passed' : ''} />`)}</div>`;
}

export function configuration_of(name) {
  const now = status_of(name)?.configuration;
  const known = subsystem_of(name)?.configurations ?? [];
  return known.find((one) => one.id === now || one.name === now) ?? (now ? {name: String(now)} : null);
}

const missed_of = new MissedLately();
replay.subscribe(() => missed_of.forget());
status.subscribe((told) => { if (told) missed_of.take(told.t ?? now_s(), told.subsystems ?? []); });
/// {count, seconds} of the last minute of a subsystem of the status; null while nobody knows.
export const missed_lately = (now) => missed_of.of(now.name, now.missed);
export const borne_missed = (name) => borne_by(name, mission.value?.links ?? []);
export const missed_title = (name, now) => Number.isFinite(now.missed) ? missed_words({missed: now.missed, cycles: now.cycles ?? 0, lately: missed_lately({...now, name}), borne: borne_missed(name)}) : '';

export const waits_text = (waits) => Array.isArray(waits) ? waits.join(', ') : waits ? String(waits) : '';

const known = computed(() => link.value.state === 'up' || replay.value !== null);
export const is_known = () => known.value;

/// "18.2 µs" with its unit in the colour of units.
function Quantity({text}) {
  const [number, unit] = String(text).split(/ (.*)/);
  return html`${number}${unit ? html`<u>${unit}</u>` : null}`;
}

export function SubsystemCard({name, chosen}) {
  slow.value;
  const now = status_of(name) ?? {};
  const state = state_name(now.state);
  const configuration = configuration_of(name);
  const waits = waits_text(now.waits_for);
  const all = [
    now.overruns > 0 ? `${now.overruns} overruns` : null,
    now.memory_kb ? `${(now.memory_kb / 1024).toFixed(1)} MB` : null,
  ].filter(Boolean).join(', ');
  const stopped = fallen_text(name), lately = missed_lately({...now, name});
  const inhibited = inhibited_text(now);
  const quiet = stopped || inhibited || waits;
  return html`<a class=${`card ${chosen ? 'chosen' : ''} ${stopped ? 'fallen' : ''} ${is_known() ? '' : 'stale'}`} href=${`#/subsystems/${name}`}
    data-test=${`subsystem-${name}`}>
    <div class="row"><b class="who_is" title=${name}>${name}</b><span class=${`state ${stopped ? 'bad' : state_look(state)}`}>${state_text(state)}</span></div>
    <${StateStrip} state=${state} />
    ${stopped ? html`<div class="notice bad" data-test=${`stopped-${name}`}>${stopped}</div>` : null}
    ${inhibited ? html`<div class="notice bad">actuators inhibited: ${inhibited}</div>` : null}
    ${waits ? html`<div class="notice amber">waits for ${waits}</div>` : null}
    ${quiet ? null : is_switched_off(name) ? html`<div class="notice">switched off</div>` : html`<div class="facts" title=${all}>
      <span>${configuration?.name.replaceAll('_', '_\u200b')}</span><span>run</span><span>late ≤</span><span class="end">missed</span>
      <b><${Quantity} text=${configuration?.sampling_hz ? rate_text(configuration.sampling_hz) : '–'} /></b>
      <b><${Quantity} text=${now.execution_mean_ns ? duration_text(now.execution_mean_ns) : '–'} /></b>
      <b><${Quantity} text=${now.latency_max_ns ? duration_text(now.latency_max_ns) : '–'} /></b>
      <b class="end" title=${missed_title(name, now)}><${Quantity} text=${lately ? `${brief_text(+rate_of(lately).toFixed(1))} /min` : now.missed ?? '–'} /></b></div>`}
  </a>`;
}
