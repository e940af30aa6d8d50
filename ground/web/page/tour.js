// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Eight steps for the first quarter of an hour. A step knows by the telemetry when it is done; nothing is locked behind it.
import {signal} from '@preact/signals';
import {commissioning_steps, fault, finished, say, send, send_and_say} from './commanding.js';
import {html} from './html.js';
import {commands, events, mission, mode_of, outcome_of, status, subsystem_of, values} from './store.js';

export const tour_at = signal(Number(sessionStorage.getItem('hirosco-tour') ?? -1));
export function tour_to(step) {
  tour_at.value = step;
  sessionStorage.setItem('hirosco-tour', String(step));
  if (steps[step]?.view) location.hash = steps[step].view;
}

async function bring_up(name) {
  const mode = mission.value.modes.find((one) => one.name === name);
  if (!mode?.commission) return say(`This mission has no mode ${name}.`, 'bad');
  for (const step of commissioning_steps(mode)) {
    if (!step.needed()) continue;
    const outcome = await finished(await send(step.subsystem, step.function, step.arguments)).catch((error) => ({stage: 'failed', reason: error.message}));
    if (outcome.stage === 'failed') return say(`${step.text}: ${outcome.reason ?? outcome.code}`, 'bad');
  }
  say(`${name} is up`, 'good');
}

const completed = (name) => commands.value.some((one) => one.function === name && outcome_of(one).stage === 'completed');
const force_n = () => Math.hypot(values.get('MANIPULATOR.TIP_FORCE[0]')?.v ?? 0, values.get('MANIPULATOR.TIP_FORCE[1]')?.v ?? 0);

const steps = [
  {title: 'Couple two machines', view: '#/overview',
    text: 'A robot and a joystick, coupled at 2 kHz. The supervisor commissioned them in order: processes, configurations, links, states. The strip of ten lamps of each subsystem shows where it is.',
    act: ['Bring telepresence up', () => bring_up('telepresence')],
    done: () => mode_of.value.name === 'telepresence' && status.value?.links?.length > 0 && status.value.links.every((one) => one.up)},
  {title: 'Move it with your hand', view: '#/overview',
    text: 'Drag the blue handle of the joystick, or the fingertip of the robot, in the 3D view. Your mouse is the hand at the joystick; the robot follows it over the real-time link.',
    act: ['Let the hand wander', () => fault('joystick', 'hand wander')], done: () => false},
  {title: 'Feel the wall', view: '#/overview',
    text: 'Press the fingertip against the rail. The red arrow is the contact force; the torque plot shows what the joystick gives back to the hand.',
    act: ['Press with 43 N', () => fault('joystick', 'hand cartesian 0.0226 0 1')], done: () => force_n() > 10},
  {title: 'A refused command, and why', view: '#/commands/MANIPULATOR/MOVE_TO',
    text: 'Coupled, the robot belongs to the joystick. Fill in MOVE_TO: before you send it, the supervisor says whether it would permit it, and why not. Send it anyway and read the verdict.',
    done: () => commands.value.some((one) => one.function === 'MOVE_TO' && outcome_of(one).stage === 'failed')},
  {title: 'Unplug the joystick', view: '#/overview',
    text: 'The test of the paper: the joystick loses its cable. Both machines must stop by themselves, at once, in order, without the ground.',
    act: ['Unplug the joystick', () => fault('joystick', 'unplug')],
    done: () => events.value.some((one) => one.name === 'JOYSTICK_LOST' || one.name === 'ROBOT_STATE_STALE')},
  {title: 'Read the story', view: '#/events',
    text: '“Why did it stop?” tells the chain of causes with on-board times: who noticed first, which plan answered, what went down. `hirosco why` prints the same.',
    done: () => false},
  {title: 'Move it by telecommand', view: '#/subsystems/MANIPULATOR',
    text: 'Plug the joystick in, bring the standalone network up by one button, and send MOVE_TO: the arm goes along a smooth path, reports half-way as progress, and completes.',
    act: ['Plug in and bring standalone up', async () => { await fault('joystick', 'plug').catch(() => {}); await bring_up('standalone'); }],
    act_2: ['MOVE_TO −1.0 1.9 in 2 s', () => send_and_say('MANIPULATOR', 'MOVE_TO', {Q1: -1.0, Q2: 1.9, DURATION: 2.0})],
    done: () => completed('MOVE_TO')},
  {title: 'Change one line of XML', view: '#/help',
    text: 'Open subsystems/manipulator/manipulator.xml and change a range or add a parameter to a housekeeping structure, then run again: forms, plots and values follow, no code is touched. docs/guide/writing_a_subsystem.md writes a new subsystem in a quarter of an hour; missions/hello flies it.',
    done: () => false},
];
export const tour_steps = steps;

export function Tour() {
  const at = tour_at.value;
  const step = steps[at];
  if (!step || !mission.value) return null;
  const able = !step.act || subsystem_of('MANIPULATOR');
  return html`<aside class="tour" data-test="tour"><div class="row"><small>tour ${at + 1} of ${steps.length}</small>
      <button class="tiny" aria-label="end the tour" onClick=${() => tour_to(-1)}>×</button></div>
    <h3>${step.title} ${step.done() ? html`<span class="tick">✓</span>` : null}</h3><p>${step.text}</p>
    <div class="row">${[step.act, step.act_2].filter(Boolean).map(([text, act]) => html`<button class="quiet" disabled=${!able} onClick=${act}>${text}</button>`)}<span class="space" />
      <button class="quiet" disabled=${at === 0} onClick=${() => tour_to(at - 1)}>back</button>
      <button class="primary" data-test="tour-next" onClick=${() => tour_to(at + 1 < steps.length ? at + 1 : -1)}>${at + 1 < steps.length ? 'next' : 'done'}</button></div>
    <div class="dots">${steps.map((_, i) => html`<i class=${i === at ? 'on' : i < at ? 'past' : ''} />`)}</div></aside>`;
}
