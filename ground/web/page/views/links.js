// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {send_and_say} from '../commanding.js';
import {duration_text, number_text, rate_text} from '../format.js';
import {html} from '../html.js';
import {LatencyBars} from '../parts/latency_bars.js';
import {LinkGraph, is_wanted, live_link, network_of} from '../parts/link_graph.js';
import {Panel} from '../parts/panel.js';
import {Splits} from '../parts/splits.js';
import {is_known} from '../parts/subsystem_card.js';
import {mission, operator, replay, slow, subsystem_of} from '../store.js';
import {listed} from './commands.js';

/// Whether the mode permits to make or to cut one; what no descriptor tells of the station judges.
function may_now(name) {
  const action = subsystem_of('SUPERVISOR')?.functions?.find((one) => one.name === name);
  return !action || listed('SUPERVISOR', action);
}

export function Links() {
  slow.value;
  const locked = Boolean(replay.value) || !operator.value;
  return html`<main class="link_view"><${Splits} name="links" />
    <${Panel} title="Real-time links" hint="point at a subsystem to see what falls with it"><${LinkGraph} width=${860} height=${380} all /></${Panel}>
    <${Panel} title="How long samples take" hint="until they are used"><${LatencyBars} /></${Panel}>
    <${Panel} title="Now"><table class="values"><thead><tr><th>link</th><th>from</th><th>to</th><th>state</th><th>rate</th><th>age</th><th>limit</th><th title="from the instant of a sample to the start of the cycle that uses it first: mean, largest">latency</th><th title="mean distance of two latencies in a row">jitter</th><th>lost</th><th>network</th><th /></tr></thead>
      <tbody>${(mission.value?.links ?? []).map((link) => {
        const now = live_link(link.id);
        const up = now.up === true;
        return html`<tr class=${is_known() ? '' : 'stale'}><td>${link.id}</td><td>${link.from}${link.provides ? html` <small>${link.provides}</small>` : null}</td>
          <td>${link.to}${link.requires ? html` <small>${link.requires}</small>` : null}</td>
          <td><b class=${`state ${up ? 'good' : is_wanted(link) ? 'bad' : 'off'}`}>${up ? 'up' : is_wanted(link) ? 'down, required' : 'not in this mode'}</b></td>
          <td class="number">${rate_text(now.rate_hz ?? NaN)}</td><td class="number">${Number.isFinite(now.age_cycles) ? now.age_cycles.toFixed(1) : '–'} cycles</td>
          <td class="number">${number_text(link.age_limit_cycles)} cycles</td><td class="number" data-test=${`latency-${link.id}`}>${duration_text(now.latency_mean_ns ?? NaN)}${up ? html` <small>≤ ${duration_text(now.latency_max_ns)}</small>` : null}</td><td class="number" data-test=${`jitter-${link.id}`}>${duration_text(now.jitter_ns ?? NaN)}</td><td class="number">${number_text(now.lost)}</td>
          <td>${[...network_of(link.from)].join(', ')}</td>
          <td><button class="chip" disabled=${locked || !may_now(up ? 'UNLINK' : 'LINK')} title=${locked || may_now(up ? 'UNLINK' : 'LINK') ? undefined : 'not in this mode'} data-test=${`link-${link.id}`} onClick=${() => send_and_say('SUPERVISOR', up ? 'UNLINK' : 'LINK', {LINK: link.id})}>${up ? 'cut' : 'make'}</button></td></tr>`;
      })}</tbody></table>
      ${mission.value?.links?.length ? null : html`<p class="empty">This mission has no real-time links.</p>`}
      <p class="about">Links join parameters of two subsystems cycle by cycle, past ground and supervisor. Who misses a required one for longer than its limit stops its own actuators.</p></${Panel}>
  </main>`;
}
