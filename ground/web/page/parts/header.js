// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useRef, useState} from 'preact/hooks';
import {answered_ms, say, send_and_say} from '../commanding.js';
import {age_text, clock_text, date_text, iso_text} from '../format.js';
import {html} from '../html.js';
import {began_before, calling, flight, link, mission, now_s, operator, replay, slow, subsystem_of} from '../store.js';
import {Commander} from './commander.js';
import {Severity} from './icons.js';
import {Mode} from './mode_menu.js';

const hold_ms = 800, longest_age_s = 1e8, slow_answer_ms = 200;

const link_words = {
  up: 'Link up', silent: 'Link silent', down: 'No spacecraft', gateway: 'No gateway', waiting: 'Waiting',
};

function LinkState() {
  const {state, age_s, rx, tx, lost, damaged, archive_failures} = link.value;
  const replaying = replay.value !== null;
  const unkept = archive_failures > 0;
  const look = replaying ? 'amber' : state === 'up' && !unkept ? 'good' : 'bad';
  const words = replaying ? 'Archive' : state === 'up' && unkept ? 'Not archived' : link_words[state];
  const title = rx === undefined ? words : `${rx} packets received, ${lost} lost, ${damaged} damaged, ${tx} sent${answered_ms.value >= 0 ? `; last answer after ${answered_ms.value.toFixed(0)} ms` : ''}${
      unkept ? `; the archive failed ${archive_failures} times: is the disk full or the file damaged?` : ''}`;
  return html`<span class=${`pill link ${look}`} title=${title} data-test="link"><i class="lamp" />${words}<small>${replaying ? 'not live' :
      state === 'gateway' || state === 'silent' ? `for ${age_text(age_s)}` : age_s < longest_age_s ? `${age_text(age_s)} ago${answered_ms.value > slow_answer_ms ? `, answers after ${age_text(answered_ms.value / 1000)}` : ''}` : ''}</small></span>`;
}

/// Of the flight: hours, minutes, seconds since it began.
const since_text = (s) => s >= 0 ? `${String(Math.floor(s / 3600)).padStart(2, '0')}${new Date(1000 * s).toISOString().slice(13, 21)}` : '--:--:--';
const clocks = {TAI: (t) => clock_text(t), UTC: (t) => iso_text(t).slice(11, 21) || '--:--:--', 'T+': (t) => since_text(t - (replay.value ? began_before(t) : flight.value?.from))};
const scales = Object.keys(clocks);

/// On-board time; a click has it as UTC and as time since the flight began.
function Clock() {
  slow.value;
  const [at, set_at] = useState(0);
  const t = now_s(), scale = scales[at], known = link.value.state === 'up' || replay.value !== null;
  const title = `On-board time${known ? '' : ' as it would be: nothing comes'}. ${scales.map((one) => `${one} ${clocks[one](t)}`).join(', ')}: a click changes it`;
  return html`<button class=${`obt ${known ? '' : 'stale'}`} title=${title} data-test="clock" onClick=${() => set_at((at + 1) % scales.length)}><small>${date_text(t)}</small>
    <b>${clocks[scale](t)}</b><small class="scale">${scale}</small></button>`;
}

/// Pressed for 0.8 s, so that neither a slip nor a held Enter of another field stops the spacecraft.
function SafeAll() {
  const [held, set_held] = useState(false);
  const timer = useRef(0);
  const press = (event) => {
    if (event.type === 'keydown' && (event.repeat || ![' ', 'Enter'].includes(event.key))) return;
    event.preventDefault();
    event.currentTarget.focus();
    if (replay.value) return say('This is a replay: SAFE ALL is locked. Go back to live first.', 'bad');
    set_held(true);
    clearTimeout(timer.current);
    timer.current = setTimeout(() => {
      set_held(false);
      timer.current = 0;
      send_and_say('SUPERVISOR', 'SAFE_ALL');
    }, hold_ms);
  };
  const release = () => {
    if (timer.current) {
      clearTimeout(timer.current);
      timer.current = 0;
      say('Hold SAFE ALL for a second to stop all actuators.');
    }
    set_held(false);
  };
  const keyup = () => release();
  return html`<button class=${`safe_all ${held ? 'held' : ''}`} data-test="safe-all" disabled=${!subsystem_of('SUPERVISOR') || !operator.value}
    title="Inhibits the actuators of every subsystem: hold for 0.8 s" onPointerDown=${press} onPointerUp=${release}
    onPointerLeave=${release} onKeyDown=${press} onKeyUp=${keyup} onBlur=${release}>
    <span>SAFE ALL</span><em>hold</em></button>`;
}

const Mark = () => html`<svg width="24" height="24" viewBox="0 0 24 24" fill="none" stroke="currentColor" stroke-width="1.8" stroke-linecap="round"
  stroke-linejoin="round" role="img" aria-label="HIROSCO"><path d="M4 20h7M7.5 20v-5.5L14 8l5 4.5M19 12.5l1.5 2.6M19 12.5l-2 2.3" /><circle cx="7.5" cy="13" r="1.9" /><circle cx="14" cy="7.6" r="1.9" /></svg>`;

export function Header({on_faults, faults_open}) {
  const {high, medium} = calling.value;
  return html`<header>
    <a class="brand" href="#/overview"><${Mark} /><span>HIROSCO</span></a>
    <span class="pill mission"><b>${mission.value?.name ?? '…'}</b>${
      mission.value?.simulated ? html`<small class="simulated">simulated</small>` : null}</span>
    <${Mode} />
    <${Commander} />
    <${LinkState} />
    <${Clock} />
    <span class="space" />
    ${[['high', high], ['medium', medium]].map(([severity, count]) => html`<a class=${`pill count ${severity} ${count ? 'has' : ''}`}
      href="#/events" data-test=${`alarms-${severity}`} title="alarms that nobody has acknowledged or shelved; a click shows them">
      <${Severity} severity=${severity} /><b>${count}</b><span class="word">${severity}</span></a>`)}
    ${operator.value ? null : html`<span class="pill" title="this token reads everything and commands nothing">observer</span>`}
    ${operator.value && mission.value?.simulated && mission.value.devices?.length ? html`
      <button class=${`quiet ${faults_open ? 'on' : ''}`} data-test="faults" title="breaks something of a simulated device" onClick=${on_faults}>Inject</button>` : null}
    <${SafeAll} />
  </header>`;
}
