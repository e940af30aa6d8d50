// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What deviated in this flight: acknowledged with a name and a note, shelved for a time, for everybody at this station. And what people did.
import {useEffect, useState} from 'preact/hooks';
import {get} from '../api.js';
import {age_text, clock_text} from '../format.js';
import {html} from '../html.js';
import {acknowledge, acknowledge_all, shelve, unshelve} from '../people.js';
import {alarms, authority, flight, mission, now_s, operator, replay, slow} from '../store.js';
import {Severity} from './icons.js';
import {Panel} from './panel.js';

const shelves = [[600, '10 min'], [3600, '1 h'], [28800, '8 h']];

/// What calls first, then by severity, then the newest.
const rank = {high: 0, medium: 1};
const in_order = (list) => list.toSorted((a, b) => Number(b.calls) - Number(a.calls) || rank[a.severity] - rank[b.severity] || b.t - a.t);

function Alarm({alarm, note, done, for_s}) {
  const may = operator.value && !replay.value;
  const {acknowledged, shelved} = alarm;
  const act = (what) => () => what().then(done);
  return html`<li class=${`${alarm.severity} ${alarm.calls ? 'calls' : ''}`} data-test=${`alarm-${alarm.name}`}>
    <${Severity} severity=${alarm.severity} /><span class="time" title=${clock_text(alarm.t, 3)}>${age_text(now_s() - alarm.t)} ago</span>
    <span class="words"><span class="who">${alarm.subsystem}</span> <b>${alarm.name}</b>${alarm.count > 1 ? html` <small>${alarm.count} times</small>` : null}
      ${shelved ? html`<small class="done">shelved by ${shelved.who} until ${clock_text(shelved.until, 0)}${shelved.note ? `: ${shelved.note}` : ''}</small>` :
        acknowledged ? html`<small class="done">${alarm.fresh ? `${alarm.fresh} more since ` : ''}acknowledged by ${acknowledged.who} at ${clock_text(acknowledged.t, 0)}${acknowledged.note ? `: ${acknowledged.note}` : ''}</small>` : null}</span>
    ${may ? html`<span class="acts">${alarm.fresh ? html`<button class="chip" data-test="acknowledge" onClick=${act(() => acknowledge(alarm, note))}>Acknowledge</button>` : null}
      ${shelved ? html`<button class="chip" onClick=${act(() => unshelve(alarm))}>Off the shelf</button>` :
        html`<button class="chip" data-test="shelve" title="does not call until then" onClick=${act(() => shelve(alarm, for_s, note))}>Shelve</button>`}</span>` : null}</li>`;
}

const did = {
  acknowledge: 'acknowledged', shelve: 'shelved', unshelve: 'took off the shelf', 'shelf over': 'no longer shelves', took: 'took the command', asked: 'asked for the command of',
  kept: 'kept the command from', 'was handed': 'was handed the command by', 'was left': 'got the command of', 'laid down': 'laid the command down', 'was idle': 'had the command, idle for 15 min',
  'was away': 'had the command, and was away', 'no longer asks': 'asked, and was away', began: 'began', named: 'named', noted: 'noted of',
};
function subject({kind, name}) {
  if (kind === 'flight') return `flight ${name}`;
  if (kind === 'stack') return `the stack ${name}`;
  if (kind !== 'alarm') return '';
  const [apid, id] = name.split('/').map(Number);
  const subsystem = mission.value?.subsystems.find((one) => one.id === apid);
  return name === '*' ? 'all alarms' : `${subsystem?.name ?? `APID ${apid}`} ${subsystem?.events.find((one) => one.id === id)?.name ?? id}`;
}

function Marks() {
  const [list, set_list] = useState(null);
  useEffect(() => { get('/api/marks', {from: flight.value?.from, limit: 200}).then((answer) => set_list(answer.marks), () => set_list([])); },
    [alarms.value, authority.value]);
  if (!list) return null;
  return html`<table class="marks" data-test="marks"><tbody>${list.map((mark) => html`<tr><td class="time">${clock_text(mark.t, 0)}</td>
    <td class="words">${mark.kind === 'flight' && mark.action === 'began' ? `${subject(mark)} began` : `${mark.who} ${did[mark.action] ?? mark.action} ${subject(mark)}`}${
      mark.until ? ` until ${clock_text(mark.until, 0)}` : ''}${mark.note ? html`<b>${mark.kind === 'alarm' ? ': ' : ' '}${mark.note}</b>` : null}</td></tr>`)}</tbody></table>
    ${list.length ? null : html`<p class="empty">Nobody has done anything yet.</p>`}`;
}

export function Alarms() {
  const [note, set_note] = useState('');
  const [for_s, set_for] = useState(shelves[0][0]);
  const [log, set_log] = useState(false);
  slow.value;
  const list = in_order(alarms.value), call = list.filter((one) => one.calls).length;
  const may = operator.value && !replay.value;
  const done = () => set_note('');
  return html`<${Panel} title="Alarms" area="alarms" hint=${call ? `${call} not acknowledged` : 'all seen'}
    tools=${html`<button class=${`chip ${log ? 'on' : ''}`} aria-pressed=${log} data-test="show-marks" title="what people did at this station" onClick=${() => set_log(!log)}>Who did what</button>`}>
    ${log ? html`<${Marks} />` : html`${may && list.length ? html`<div class="toolbar"><input class="search" maxlength="200" placeholder="a note, if you like" aria-label="note to the alarm" data-test="alarm-note" value=${note}
        onInput=${(event) => set_note(event.currentTarget.value)} />
      <label class="shelf">shelve for <select aria-label="for how long an alarm is shelved" value=${for_s} onChange=${(event) => set_for(Number(event.currentTarget.value))}>${shelves.map(([s, text]) => html`<option value=${s}>${text}</option>`)}</select></label>
      ${call > 1 ? html`<button class="chip" data-test="acknowledge-all" onClick=${() => acknowledge_all(note).then(done)}>Acknowledge all</button>` : null}</div>` : null}
    <ol class="alarms" data-test="alarms">${list.map((alarm) => html`<${Alarm} key=${`${alarm.apid}/${alarm.id}`} alarm=${alarm} note=${note} done=${done} for_s=${for_s} />`)}</ol>
    ${list.length ? null : html`<p class="empty">Nothing of medium or high severity in this flight.</p>`}`}</${Panel}>`;
}
