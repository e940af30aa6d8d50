// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {html} from '../html.js';
import {EventTable} from '../parts/event_list.js';
import {Lanes} from '../parts/lanes.js';
import {Panel} from '../parts/panel.js';
import {speeds} from '../parts/replay_bar.js';
import {Robot} from '../parts/robot.js';
import {events, live, now_s, replay, replay_from, slow} from '../store.js';

const spans = [[60, '1 min'], [300, '5 min'], [900, '15 min'], [3600, '1 h']];

export function Timeline() {
  const [window_s, set_window] = useState(300);
  slow.value;
  return html`<main class="timeline_view">
    <${Panel} title="Timeline" area="lanes" hint="click anywhere to replay from there">
      <div class="toolbar">${spans.map(([seconds, text]) => html`<button class=${`chip ${seconds === window_s ? 'on' : ''}`} onClick=${() => set_window(seconds)}>${text}</button>`)}
        <span class="space" />
        ${[10, 30, 60].map((back) => html`<button class="chip" data-test=${`replay-${back}`} onClick=${() => replay_from(now_s() - back)}>replay ${back} s back</button>`)}
        ${replay.value ? html`${speeds.map((one) => html`<button class=${`chip ${replay.value.speed === one ? 'on' : ''}`} onClick=${() => replay_from(now_s(), one)}>${one}×</button>`)}
          <button class="chip on" onClick=${live}>back to LIVE</button>` : null}</div>
      <${Lanes} window_s=${window_s} big /></${Panel}>
    <${Panel} title="3D" area="robot" bare><${Robot} /></${Panel}>
    <${Panel} title="Events" area="events" hint=${replay.value ? 'until the replayed moment' : ''}><${EventTable} list=${events.value} most=${100} /></${Panel}>
  </main>`;
}
