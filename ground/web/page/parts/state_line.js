// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// One line that is always there: is it well, or what is going on? A stop and a replay say so in its place, so that nothing moves when they come.
import {state_name} from '../commanding.js';
import {age_text, clock_text, state_text} from '../format.js';
import {html} from '../html.js';
import {fallen, risen, stop} from '../stop_story.js';
import {calling, link, mission, mode_of, now_s, other_version, replay, status} from '../store.js';
import {is_wanted} from './link_graph.js';
import {share_text} from './missed.js';
import {changing, under_way} from './mode_menu.js';
import {missed_lately} from './subsystem_card.js';

const counted = (count, what) => `${count} ${what}${count === 1 ? '' : 's'}`;

/// How many of those who are to be up are, links, cycles that were missed lately.
function Well() {
  const list = status.value?.subsystems ?? [], links = (status.value?.links ?? []).filter((one) => one.up || is_wanted(one)), mode = mode_of.value;
  const up = list.filter((one) => state_name(one.state) === 'Operational').length;
  const missing = list.map((one) => ({name: one.name, ...missed_lately(one)})).filter((one) => one.count > 0);
  const {high, medium} = calling.value, since = risen.value?.name === mode.name && !fallen.value.length ? ` since ${clock_text(risen.value.t, 0)}` : '';
  const head = mode.commission?.length ? `${mode.name} is up${since}` : `Mode ${mode.name}`;
  return html`<b data-test="state-head">${head}</b><span>${up} of ${list.length} Operational${links.length ? `, ${links.filter((one) => one.up).length} of ${counted(links.length, 'link')} up` : ''}</span>
    ${missing.length ? html`<a href="#/links" data-test="state-missed" title="What stops a subsystem is too many in a row, not their number: see the links.">cycles missed in the last minute: ${
      missing.map((one) => `${one.name} ${share_text(one)}`).join(', ')}, too few in a row to stop anybody</a>` : html`<span data-test="state-missed">no cycle missed in the last minute</span>`}
    ${high + medium ? html`<a href="#/events">${counted(high + medium, 'alarm')} nobody has acknowledged</a>` : null}`;
}

function words() {
  const {state, age_s} = link.value, now = under_way(), down = fallen.value, other = other_version.value;
  if (other) return html`<b data-test="state-head" class="amber_text">The ground station is of another version than this page</b><span>${other.station}, this page of ${other.page}</span>
    <button data-test="load-again" onClick=${() => location.reload()}>Load the page again</button>`;
  if (now) return html`<b data-test="state-head">${now.name} is being brought up${now.all ? `: ${now.done} of ${now.all}` : ''}</b><span>${now.text}</span>
    ${now.all ? html`<progress max=${now.all} value=${now.done} aria-label=${`${now.done} of ${now.all} steps`} />` : null}`;
  if (changing.value?.failed) return html`<b data-test="state-head">${changing.value.name} was refused</b><span title=${changing.value.failed}>${changing.value.failed}</span>`;
  if (state === 'silent' || state === 'gateway') return html`<b data-test="state-head">Nothing new for ${age_text(age_s)}</b><span>what is shown is old</span>`;
  if (state !== 'up' || !status.value) return html`<span data-test="state-head">Waiting for the spacecraft.</span>`;
  if (down.length) return html`<b data-test="state-head" class="amber_text">${mode_of.value.name} is not whole</b><span>${down.map((one) => `${one.subsystem} is ${state_text(one.state)}`).join(', ')}</span>`;
  return html`<${Well} />`;
}

export function StateLine() {
  if (replay.value || stop.value || !mission.value) return null;
  return html`<div class="state_line" role="status" data-test="state-line">${words()}</div>`;
}
