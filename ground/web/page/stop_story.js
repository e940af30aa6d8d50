// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What stopped and why, latched until somebody has seen it. The words are the gateway's (GET /api/why), the same as `hirosco why`.
import {computed, effect, signal} from '@preact/signals';
import {get} from './api.js';
import {bring_up, say, state_name} from './commanding.js';
import {acknowledge_all} from './people.js';
import {calling, commands, events, flight, gateway, link, mission, mode_of, now_s, replay, seen_until, status, status_of, subsystem_of} from './store.js';

/// The newest story, whatever became of it since; null while none is known.
export const story = signal(null);

/// For everybody: the station keeps it, with the name of who did.
export const acknowledge = (note = '') => acknowledge_all(note);

/// The story that nobody has acknowledged yet; null in a replay, which has its own time.
export const stop = computed(() => {
  const told = story.value;
  if (!told || replay.value || told.t <= (seen_until.value ?? -Infinity) || told.t < (flight.value?.from ?? -Infinity)) return null;
  return told.stopped?.length || told.severity === 'high' ? told : null;
});

async function look() {
  const found = await get('/api/why', {to: replay.value?.at}).catch(() => null);
  if (found) story.value = found.causes?.length ? found : null;
}

/// What stopped comes in several packets, the states and links of housekeeping last.
const looks_after_ms = [100, 600, 1500, 4000];
let timers = [];
function look_again() {
  for (const timer of timers) clearTimeout(timer);
  timers = looks_after_ms.map((after_ms) => setTimeout(look, after_ms));
}
const newest_of_weight = computed(() => events.value.find((event) => event.severity === 'high' || event.severity === 'medium')?.key ?? '');
const newest_safe_all = computed(() => {
  const found = commands.value.find((one) => one.function === 'SAFE_ALL');
  return found ? `${found.id} ${found.stages.length}` : '';
});
effect(() => {
  newest_of_weight.value;
  newest_safe_all.value;
  if (gateway.value.connected || replay.value) look_again();
});

/// Members of the present mode that are not where it has them, or whose actuators are inhibited: [{subsystem, state, wanted}].
export const fallen = computed(() => (mode_of.value.commission ?? []).flatMap((member) => {
  const now = status_of(member.subsystem);
  if (!now) return [];
  const state = state_name(now.state);
  const lower = state !== member.state || (Array.isArray(now.inhibited) && now.inhibited.length > 0);
  return lower ? [{subsystem: member.subsystem, state, wanted: member.state}] : [];
}));

/// The mode that is up with all its members; empty where one is lacking, or nobody is to be up; undefined while nobody knows.
const whole = computed(() => {
  if (replay.value || link.value.state !== 'up' || mode_of.value.name === 'unknown') return undefined;
  return mode_of.value.commission?.length && !fallen.value.length ? mode_of.value.name : '';
});
/// {name, t} of what came up while this page looked on, whoever brought it up; null before.
export const risen = signal(null);
let was_whole;
effect(() => {
  const now = whole.value;
  if (now && was_whole !== undefined && now !== was_whole) {
    risen.value = {name: now, t: now_s()};
    say(`${now} is up`, 'good');
  }
  was_whole = now;
});

const reasons = {
  stop: 'stopped by the supervisor or SAFE ALL', link: 'a link that it requires is missing', device: 'its device is lost',
  author: 'its own protection tripped', failure: 'its cycle failed', supervisor: 'the supervisor does not answer',
  awaited: 'a device or producer has not answered yet',
};
/// Why the actuators of a subsystem are inhibited, in words; empty when they are not.
export function inhibited_text(now) {
  const bits = Array.isArray(now?.inhibited) ? [...now.inhibited] : [];
  const protection = () => {
    const event = events.value.find((one) => one.subsystem === now.name && (one.severity === 'high' || one.severity === 'medium'));
    return event ? `${reasons.author}: ${event.name.toLowerCase().replaceAll('_', ' ')}` : reasons.author;
  };
  // Last: whoever has a reason of his own is stopped by the supervisor because of it.
  bits.sort((a, b) => (a === 'stop') - (b === 'stop'));
  return bits.map((bit) => bit === 'author' ? protection() : reasons[bit] ?? bit).join(', ');
}

/// Why a subsystem is not where its mode has it.
export function fallen_text(name) {
  const told = story.value;
  if (!fallen.value.some((one) => one.subsystem === name)) return '';
  if (told?.stopped?.includes(name)) return `stopped by plan ${told.plan}: ${told.title.split('. ')[0].replace(/\.$/, '')}`;
  if (told?.stopped?.includes('all')) return 'stopped by SAFE ALL';
  return `mode ${mode_of.value.name} has it ${state_name(fallen.value.find((one) => one.subsystem === name).wanted)}`;
}

/// Progress of a bring-up that the banner began: its steps, null before.
export const rising = signal(null);
export async function bring_up_again() {
  const told = story.value;
  const mode = mission.value.modes.find((one) => one.name === told?.mode_up) ??
    mission.value.modes.find((one) => one.name === mission.value.start_mode);
  if (!mode || rising.value?.running) return;
  rising.value = {running: true, steps: [], mode: mode.name};
  const steps = await bring_up(mode, (list) => { rising.value = {running: true, steps: [...list], mode: mode.name}; });
  const failed = steps.find((step) => step.stage === 'failed');
  rising.value = {running: false, steps, failed, mode: mode.name};
  if (failed) return;
  const open = calling.value.high + calling.value.medium;
  await acknowledge(`brought ${mode.name} up`);
  if (open) say(`${mode.name} is up. ${open === 1 ? 'The alarm' : `The ${open} alarms`} of before counted as acknowledged: see Events.`, 'good');
  rising.value = null;
}

export const is_switched_off = (name) => state_name(status_of(name)?.state) === 'Offline' && !fallen.value.some((one) => one.subsystem === name) &&
  Boolean(subsystem_of(name));
