// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A stop, said where one looks, until it is acknowledged or mended: who and why, when, what went down, what is still well, the way out.
import {bringing} from '../commanding.js';
import {clock_text} from '../format.js';
import {html} from '../html.js';
import {link, mission, mode_of, operator, replay_from} from '../store.js';
import {acknowledge, bring_up_again, fallen, rising, stop} from '../stop_story.js';
import {plot_names, scene_of_mission} from './scene_file.js';
import {Severity} from './icons.js';

function Rising() {
  const {failed, mode} = rising.value, now = bringing.value;
  if (failed) return html`<p class="second" data-test="stop-failed"><b>${mode} is not up.</b> “${failed.text}”: ${failed.reason ?? `code ${failed.code}`}</p>`;
  return html`<p class="second" data-test="stop-rising">${now ? `Bringing ${mode} up: ${now.done} of ${now.all}, ${now.text}` : `${mode} is up`}</p>`;
}

export function StopBanner() {
  const told = stop.value;
  if (!told) return null;
  const plots = plot_names(scene_of_mission.value?.plots?.at(-1));
  // A mode that has nobody up says nothing of who was stopped.
  const up_again = fallen.value.length === 0 && mode_of.value.commission?.length > 0;
  const mode = mission.value?.modes.find((one) => one.name === told.mode && one.commission?.length)?.name ?? mission.value?.start_mode;
  const replay_it = () => {
    location.hash = '#/overview';
    replay_from(told.t - 5, 1);
  };
  return html`<section class="stop_banner" role="alert" data-test="stop-banner">
    <${Severity} severity=${told.severity} />
    <div class="words"><p class="first" data-test="stop-title" title=${told.title}>${told.title}</p>
      ${rising.value ? html`<${Rising} />` : html`<p class="second" title=${`${told.detail} ${told.advice}`}><b>${clock_text(told.t, 3)}</b> ${up_again ? 'It is up again.' : told.advice} ${told.detail}</p>`}</div>
    <a class="out" href="#/events" data-test="stop-why">Why</a>
    <button class="out" onClick=${replay_it} data-test="stop-replay">Replay 5 s before</button>
    <a class="out" href=${plots.length ? `#/plots?p=${plots.map(encodeURIComponent).join('+')}` : '#/plots'} data-test="stop-plot">Plot</a>
    ${operator.value ? html`<button class=${up_again && !rising.value ? 'way_out' : 'out'} onClick=${() => acknowledge()} data-test="stop-acknowledge">Acknowledge</button>` : null}
    ${operator.value && mode && (!up_again || rising.value) ? html`<button class="way_out" data-test="stop-bring-up" title="tells at its steps whether what was lost is back" disabled=${rising.value?.running || link.value.state !== 'up'}
      onClick=${bring_up_again}>Bring ${mode} up</button>` : null}
  </section>`;
}

/// The chain of a story: the cause first, then what it brought about, by milliseconds.
export const Chain = ({causes}) => html`<ol class="why" data-test="why">${causes.map((cause) => html`<li class=${cause.severity ?? 'info'}>
  <button class="time" title=${`${clock_text(cause.t, 4)}: replay from a second before`} onClick=${() => replay_from(cause.t - 1, 1)}>${Number.isFinite(cause.after_ms) ? `+${cause.after_ms.toFixed(1)} ms` : 'before'}</button>
  <${Severity} severity=${cause.severity ?? 'info'} /><span>${cause.text}</span></li>`)}</ol>`;
