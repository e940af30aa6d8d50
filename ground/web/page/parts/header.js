// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useRef, useState} from 'preact/hooks';
import {say, send_and_say} from '../commanding.js';
import {age_text, clock_text, date_text, state_text} from '../format.js';
import {html} from '../html.js';
import {link, mission, mode_of, now_s, operator, replay, see_events, slow, subsystem_of, unseen} from '../store.js';
import {fallen} from '../stop.js';
import {Severity} from './icons.js';

const hold_ms = 800;

const link_words = {
  up: 'LINK UP', silent: 'LINK SILENT', down: 'NO SPACECRAFT', gateway: 'NO GATEWAY', waiting: 'WAITING',
};

function LinkState() {
  const {state, age_s, rx, tx, lost, damaged, archive_failures} = link.value;
  const replaying = replay.value !== null;
  const unkept = archive_failures > 0;
  const look = replaying ? 'amber' : state === 'up' && !unkept ? 'good' : 'bad';
  const words = replaying ? 'ARCHIVE' : state === 'up' && unkept ? 'NOT ARCHIVED' : link_words[state];
  const title = rx === undefined ? words : `${rx} packets received, ${lost} lost, ${damaged} damaged, ${tx} sent${
      unkept ? `; the archive failed ${archive_failures} times: is the disk full or the file damaged?` : ''}`;
  return html`<span class=${`pill link ${look}`} title=${title} data-test="link"><i class="lamp" />${words}<small>${replaying ? 'not live' :
      state === 'gateway' || state === 'silent' ? `for ${age_text(age_s)}` : `age ${age_text(age_s)}`}</small></span>`;
}

/// The mode, and whether it is true: what its members have fallen from is no telepresence any more.
function Mode() {
  const down = fallen.value;
  const words = down.map((one) => `${one.subsystem} is ${state_text(one.state)}`).join(', ');
  return html`<span class=${`pill mode ${down.length ? 'bad' : ''}`} data-test="mode" title=${words || 'every member is where this mode has it'}><small>mode</small><b>${
    mode_of.value.name}</b>${down.length ? html`<em data-test="mode-stopped">stopped</em>` : null}</span>`;
}

function Clock() {
  slow.value;
  const t = now_s();
  const known = link.value.state === 'up' || replay.value !== null;
  return html`<span class=${`obt ${known ? '' : 'stale'}`} title=${known ? 'On-board time' : 'On-board time as it would be: nothing comes'}><small>${date_text(t)}</small>
    <b>${clock_text(t)}</b><small>OBT</small></span>`;
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
  return html`<button class=${`safe_all ${held ? 'held' : ''}`} data-test="safe-all" disabled=${!subsystem_of('SUPERVISOR')}
    title="Inhibits the actuators of every subsystem: hold for 0.8 s" onPointerDown=${press} onPointerUp=${release}
    onPointerLeave=${release} onKeyDown=${press} onKeyUp=${keyup} onBlur=${release}>
    <span>SAFE ALL</span><em>hold</em></button>`;
}

export function Header({on_faults, faults_open}) {
  const {high, medium} = unseen.value;
  return html`<header>
    <a class="brand" href="#/overview"><img src="icon.svg" alt="HIROSCO" width="22" height="22" /><span aria-hidden="true">HIROSCO</span></a>
    <span class="pill mission"><small>mission</small><b>${mission.value?.name ?? '…'}</b>${
      mission.value?.simulated ? html`<small class="simulated">simulated</small>` : null}</span>
    <${Mode} />
    <${LinkState} />
    <${Clock} />
    <a class=${`pill count ${high ? 'has' : ''}`} href="#/events?severity=high" onClick=${see_events} title="not looked at in the last hour; a click shows them"><${Severity} severity="high" />${high} high</a>
    <a class=${`pill count ${medium ? 'has' : ''}`} href="#/events?severity=medium" onClick=${see_events} title="not looked at in the last hour; a click shows them">
      <${Severity} severity="medium" />${medium} medium</a>
    <span class="space" />
    ${operator.value ? null : html`<span class="pill" title="this token reads everything and commands nothing">observer</span>`}
    ${mission.value?.simulated && mission.value.devices?.length ? html`
      <button class=${`quiet ${faults_open ? 'on' : ''}`} data-test="faults" onClick=${on_faults}>Faults</button>` : null}
    <${SafeAll} />
  </header>`;
}
