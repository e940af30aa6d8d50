// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The tour of a mission: page/tour.js of its folder has the steps, a mission without one has those below. A step knows by the telemetry
// when it is done; nothing is locked behind it.
import {signal} from '@preact/signals';
import {bring_up, fault, say, send_and_say, state_name} from './commanding.js';
import {html} from './html.js';
import {mission_code, mission_has} from './mission_files.js';
import {commands, events, injections, mission, mode_of, outcome_of, slow, status, status_of, subsystem_of, values} from './store.js';

/// What a mission's tour may use; README.md says what a step is.
const page = {bring_up, commands, events, fault, injections, mission, mode_of, outcome_of, say, send_and_say, state_name, status, status_of,
  subsystem_of, values};

const usual_steps = [
  {title: 'Look around', view: '#/subsystems',
    text: 'Each subsystem says in which of its ten states it is, how its cycle keeps its time and what it measures, as its descriptor has it.',
    done: () => Boolean(status.value?.subsystems?.some((one) => state_name(one.state) === 'Operational'))},
  {title: 'Send a telecommand', view: '#/commands',
    text: 'Choose one, fill in its form and send it. The supervisor says beforehand whether the mode permits it, logs it and reports how it ended.',
    done: () => commands.value.some((one) => outcome_of(one).stage === 'completed')},
  {title: 'Read the story', view: '#/events',
    text: 'Every event and every refusal is here with its on-board time, as “hirosco log” has it. In the timeline a click replays the moment before.',
    done: () => location.hash.startsWith('#/events')},
];
export const tour_steps = signal([]);
const steps_known = mission_has('tour.js')
    .then((there) => there ? mission_code('tour.js') : null)
    .then((own) => own ? own.tour(page) : usual_steps)
    .catch((error) => {
      say(`The mission's tour cannot be read: ${error.message}`, 'bad');
      return usual_steps;
    })
    .then((steps) => { tour_steps.value = steps; });

/// Kept beyond the tab: a tour may end one flight and go on in the next, whose URL is another one.
const kept = 'hirosco-tour';
export const tour_at = signal(Number(sessionStorage.getItem(kept) ?? -1));
export function tour_to(at) {
  tour_at.value = at;
  sessionStorage.setItem(kept, String(at));
  localStorage.setItem(kept, String(at));
  const step = tour_steps.value[at];
  step?.enter?.();
  if (step?.view) location.hash = step.view;
}

/// From the beginning, or where the last flight was ended for the sake of the tour.
export async function tour_from_url() {
  await steps_known;
  const at = Math.min(Number(localStorage.getItem(kept)), tour_steps.value.length - 1);
  tour_at.value = tour_steps.value[at]?.next_flight ? at : 0;
  sessionStorage.setItem(kept, String(tour_at.value));
  location.hash = tour_steps.value[tour_at.value].view;
}

export function Tour() {
  slow.value;
  const at = tour_at.value, steps = tour_steps.value;
  const step = steps[at];
  if (!step || !mission.value) return null;
  return html`<aside class="tour" data-test="tour"><div class="row"><small>tour ${at + 1} of ${steps.length}</small>
      <button class="tiny" aria-label="end the tour" onClick=${() => tour_to(-1)}>×</button></div>
    <h3>${step.title} ${step.done() ? html`<span class="tick" data-test="tour-done">✓</span>` : null}</h3><p>${step.text}</p>
    <div class="row">${[step.act, step.act_2, step.act_3].filter(Boolean).map(([text, act]) => html`<button class="quiet" data-test="tour-act" onClick=${act}>${text}</button>`)}<span class="space" />
      <button class="quiet" disabled=${at === 0} onClick=${() => tour_to(at - 1)}>back</button>
      <button class="primary" data-test="tour-next" onClick=${() => tour_to(at + 1 < steps.length ? at + 1 : -1)}>${at + 1 < steps.length ? 'next' : 'done'}</button></div>
    <div class="dots">${steps.map((_, i) => html`<i class=${i === at ? 'on' : i < at ? 'past' : ''} />`)}</div></aside>`;
}
