// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Eight steps for the first quarter of an hour with this mission. A step knows by the telemetry when it is done; nothing is locked
// behind it. `page` is what ground/web/page/tour.js hands over.

/// Kept beyond the tab: one step ends with a new flight, whose URL is another one.
const kept_descriptors = 'hirosco-tour-mission';

export function tour(page) {
  const {bring_up, commands, events, fault, injections, mission, mode_of, outcome_of, say, send_and_say, state_name, status, status_of,
    subsystem_of, values} = page;
  const told_by_descriptors = () => mission.value ? JSON.stringify([mission.value.subsystems, mission.value.modes]) : '';

  async function couple(name) {
    const mode = mission.value.modes.find((one) => one.name === name);
    if (!mode?.commission) return say(`This mission has no mode ${name}.`, 'bad');
    const failed = (await bring_up(mode)).find((step) => step.stage === 'failed');
    if (failed) say(`${failed.text}: ${failed.reason ?? failed.code}`, 'bad');
  }

  /// The wall of the next step is where the arm stands at home.
  async function home_and_couple() {
    // Both where they begin: what the handle stands at when it is coupled becomes its middle.
    await fault('joystick', 'hand hold 0 0', {quiet: true}).catch(() => {});
    if (mode_of.value.name === 'standalone' && (await send_and_say('MANIPULATOR', 'HOME')).stage === 'failed') return;
    await couple('telepresence');
  }

  async function plug_in_and_couple() {
    await fault('joystick', 'plug', {quiet: true}).catch(() => {});
    await couple('telepresence');
  }

  const sent = (name, stage) => commands.value.some((one) => one.function === name && outcome_of(one).stage === stage);
  const force_n = () => Math.hypot(values.get('MANIPULATOR.TIP_FORCE[0]')?.v ?? 0, values.get('MANIPULATOR.TIP_FORCE[1]')?.v ?? 0);
  const is_coupled = () => mode_of.value.name === 'telepresence' && (status.value?.links?.filter((one) => one.up).length ?? 0) >= 2;
  const has_fallen = () => events.value.some((one) => one.name === 'JOYSTICK_LOST') && state_name(status_of('MANIPULATOR')?.state) === 'Offline';

  return [
    {title: 'Move it', view: '#/overview',
      text: 'Drag the violet handle of the joystick, or the fingertip of the robot, in the 3D view: your mouse is the hand at the joystick, and the robot follows. White is measured, teal touched, violet what the hand feels; a blue ghost is the goal of a telecommand.',
      act: ['Let the hand wander', () => fault('joystick', 'hand wander')],
      done: () => injections.value.some((one) => one.line?.startsWith('hand'))},
    {title: 'Couple two machines', view: '#/subsystems/MANIPULATOR',
      text: 'Two processes at 2 kHz, joined by two real-time links. Take them apart, send the arm somewhere by telecommand, and couple them again: each step of the commissioning is a telecommand that the supervisor permits and logs.',
      act: ['Take apart', () => couple('standalone')], act_2: ['MOVE_TO −1.0 1.9 in 2 s', () => send_and_say('MANIPULATOR', 'MOVE_TO', {Q1: -1.0, Q2: 1.9, DURATION: 2.0})],
      act_3: ['Home, and couple', home_and_couple],
      // An arm that is coupled takes no MOVE_TO: it was apart. How it was coupled again is the visitor's.
      done: () => is_coupled() && sent('MOVE_TO', 'completed')},
    {title: 'Feel the wall', view: '#/overview',
      text: 'Press the fingertip against the rail, by mouse or by the button. The teal arrow is the contact force, with its number; “Touched and felt” below plots that number, and what the joystick gives back to the hand.',
      act: ['Press with 43 N', () => fault('joystick', 'hand cartesian 0.0226 0 1')], done: () => force_n() > 10},
    {title: 'Unplug the joystick', view: '#/overview',
      text: 'The test of the paper: the joystick loses its cable. Both machines must stop by themselves, at once and in order, without the ground: watch the ten lamps of each.',
      act: ['Unplug the joystick', () => fault('joystick', 'unplug')], done: has_fallen},
    {title: 'Read the story', view: '#/events',
      text: '“Why did it stop?” tells the chain of causes with on-board times: who noticed first, which plan answered, what went down. “hirosco why” prints the same. In the timeline a click replays the moment before.',
      done: () => has_fallen() && location.hash.startsWith('#/events')},
    {title: 'A refused command, and why', view: '#/commands/MANIPULATOR/MOVE_TO',
      text: 'Plug in and couple again. Coupled, the robot belongs to the joystick: fill in MOVE_TO, and before you send it the supervisor says that it would refuse, and why. Send it anyway and read the verdict.',
      act: ['Plug in and couple', plug_in_and_couple],
      done: () => sent('MOVE_TO', 'failed')},
    {title: 'Change one line of XML', view: '#/commands/JOYSTICK/SET_FORCE_SCALE', next_flight: true,
      enter: () => localStorage.setItem(kept_descriptors, told_by_descriptors()),
      text: 'This form stands in subsystems/joystick/joystick.xml: look for the parameter FORCE_SCALE, change its maximum, end the flight with Ctrl-C and start “hirosco tour” again. The form takes the new range, the supervisor refuses by it, no code was touched.',
      done: () => { const before = localStorage.getItem(kept_descriptors); return Boolean(before) && before !== told_by_descriptors(); }},
    {title: 'A new subsystem', view: '#/help', next_flight: true,
      text: 'docs/guide/writing_a_subsystem.md writes one in a quarter of an hour: a descriptor and a step function. missions/hello is the smallest that flies: end this flight and start “hirosco tour hello”. Its forms, values and plots are here without a word about it in the page.',
      done: () => Boolean(mission.value) && !subsystem_of('MANIPULATOR')},
  ];
}
