// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What several people at one station share: who commands, alarms that somebody has seen, names and notes of flights, stacks of telecommands; and who looks. All of it is the station's, which
// keeps it and tells every page (docs/adr/0105).
import {computed, effect} from '@preact/signals';
import {post, seat} from './api.js';
import {operator_name, say, signed} from './commanding.js';
import {authority, flights, kept_stacks, operator, own_client, present, replay, send_to_gateway} from './store.js';

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

/// Who else has a page open here: {pages: the other ones that may command, observers: how many of them, count}.
export const others = computed(() => {
  const pages = (present.value?.pages ?? []).filter((one) => one.client !== own_client.value);
  const count = Math.max(0, (present.value?.operators ?? 0) + (present.value?.observers ?? 0) - 1);
  const watching = Math.max(0, (present.value?.observers ?? 0) - (operator.value ? 0 : 1));
  return {pages: pages.filter((one) => one.operator), observers: watching, count};
});
/// Others know this page by its name: said to each gateway anew, and when it has been typed.
const typed_ms = 400;
let name_timer = 0, named = false;
effect(() => {
  const name = operator_name.value;
  if (!own_client.value || !(name || named)) return;
  named = true;
  clearTimeout(name_timer);
  name_timer = setTimeout(() => send_to_gateway({type: 'name', name}), typed_ms);
});

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

/// True: the station has it, and tells everybody.
export const note_flight = async (flight, note) => Boolean(await act('/api/flights', {flight, note}));

/// For everybody at this station; without a text it is forgotten.
export async function keep_stack(name, text) {
  const answer = await act('/api/stacks', {name, text});
  if (answer) kept_stacks.value = answer.stacks;
  return Boolean(answer);
}

/// Whether a telecommand of this page would be taken by the station: what is essential always is.
export const may_send = (action) => operator.value && !replay.value && (action?.essential || command_is.value !== 'other');
