// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {copy} from '../commanding.js';
import {html} from '../html.js';
import {EventTable} from '../parts/event_list.js';
import {Flights} from '../parts/flights.js';
import {Lanes} from '../parts/lanes.js';
import {Panel} from '../parts/panel.js';
import {Robot} from '../parts/robot.js';
import {Splits} from '../parts/splits.js';
import {events, moment_link, now_s, replay, replay_from, slow} from '../store.js';

const spans = [[1, '1 s'], [60, '1 min'], [300, '5 min'], [3600, '1 h'], [86400, '1 d']];

const span_text = (s) => s < 1 ? `${+(s * 1000).toPrecision(3)} ms` : s < 100 ? `${+s.toPrecision(3)} s` : s < 6000 ? `${+(s / 60).toPrecision(3)} min` : `${+(s / 3600).toPrecision(3)} h`;

export function Timeline() {
  const [view, set_view] = useState({span_s: 300, end: null});
  slow.value;
  return html`<main class="timeline_view"><${Splits} name="timeline" rows=${false} />
    <${Panel} title="Timeline" area="lanes" hint="wheel: 1 ms to a day; with Shift along it; a click replays from there">
      <div class="toolbar">${spans.map(([seconds, text]) => html`<button class=${`chip ${seconds === view.span_s ? 'on' : ''}`} onClick=${() => set_view({span_s: seconds, end: view.end})}>${text}</button>`)}
        <small data-test="span">${span_text(view.span_s)}</small>
        ${view.end !== null ? html`<button class="chip" data-test="follow" onClick=${() => set_view({span_s: Math.max(60, view.span_s), end: null})}>follow</button>` : null}
        <span class="space" />
        ${[10, 30, 60].map((back) => html`<button class="chip" data-test=${`replay-${back}`} onClick=${() => replay_from(now_s() - back)}>replay ${back} s back</button>`)}
        ${replay.value ? null : html`<button class="chip" title="who opens it in a page of this station sees this moment" onClick=${() => copy(moment_link(), 'link to this moment copied; no token is in it')}>copy link to now</button>`}</div>
      <${Lanes} window_s=${view.span_s} end=${view.end} on_view=${set_view} big /></${Panel}>
    <${Panel} title="3D" area="robot" bare><${Robot} /></${Panel}>
    <${Flights} on_look=${set_view} />
    <${Panel} title="Events" area="events" hint=${replay.value ? 'until the replayed moment' : 'of this flight'}><${EventTable} list=${events.value} most=${100} /></${Panel}>
  </main>`;
}
