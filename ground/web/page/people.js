// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What several people at one station share: who commands, alarms that somebody has seen, names of flights, stacks of telecommands. All of it is the station's, which
// keeps it and tells every page (docs/adr/0105).
import {computed} from '@preact/signals';
import {post, seat} from './api.js';
import {say, signed} from './commanding.js';
import {authority, flights, kept_stacks, operator, replay} from './store.js';

/// Whether this page commands, another one does ('other'), or nobody ('free').
export const command_is = computed(() => {
  const holder = authority.value?.holder;
  return !holder ? 'free' : holder.seat === seat ? 'mine' : 'other';
});
export const commander = computed(() => authority.value?.holder?.name ?? '');
/// Somebody asks this page for the command: {name, answer_s, at_ms}.
export const asked = computed(() => {
  const now = authority.value;
  return command_is.value === 'mine' && now.asking ? {...now.asking, at_ms: now.at_ms} : null;
});
export const i_ask = computed(() => authority.value?.asking?.seat === seat);

async function act(path, body) {
  if (replay.value) return say('This is a replay: go back to live first.', 'bad');
  try {
    return await post(path, {...signed(), ...body});
  } catch (error) {
    say(error.message, 'bad');
    return null;
  }
}

export const take_command = () => act('/api/authority', {action: 'take'});
export const keep_command = () => act('/api/authority', {action: 'keep'});
export const hand_over = () => act('/api/authority', {action: 'hand_over'});

export const acknowledge = (alarm, note) => act('/api/alarms', {subsystem: alarm.subsystem, event: alarm.name, action: 'acknowledge', note});
export const acknowledge_all = (note) => act('/api/alarms', {subsystem: '*', action: 'acknowledge', note});
export const shelve = (alarm, for_s, note) => act('/api/alarms', {subsystem: alarm.subsystem, event: alarm.name, action: 'shelve', for_s, note});
export const unshelve = (alarm) => act('/api/alarms', {subsystem: alarm.subsystem, event: alarm.name, action: 'unshelve'});

export async function name_flight(flight, name) {
  if (await act('/api/flights', {flight, name})) flights.value = flights.value.map((one) => one.id === flight ? {...one, name} : one);
}

/// For everybody at this station; without a text it is forgotten.
export async function keep_stack(name, text) {
  const answer = await act('/api/stacks', {name, text});
  if (answer) kept_stacks.value = answer.stacks;
  return Boolean(answer);
}

/// Whether a telecommand of this page would be taken by the station: what is essential always is.
export const may_send = (action) => operator.value && !replay.value && (action?.essential || command_is.value !== 'other');
