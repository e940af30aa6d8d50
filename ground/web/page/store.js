// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What the page knows, as signals: the mission's descriptors, the newest status and values, events, command reports, and
// whether all this is live or from the archive. One source at a time: going to a replay and back empties what depends on time.
import {batch, computed, effect, signal} from '@preact/signals';
import {get, introduce, seat, token} from './api.js';
import {when_through} from './through.js';

const most_events = 10000;
const most_commands = 500;
const most_gaps = 1000;
const slow_period_ms = 200, pictures_ms = 120;

export const mission = signal(null);
export const status = signal(null);
export const events = signal([]);
export const commands = signal([]);
export const gaps = signal([]);
/// How often something that was missed has come from the log on board.
export const filled = signal(0);
export const replay = signal(null);
export const gateway = signal({connected: false, since_ms: performance.now(), refused: false});
export const problem = signal('');
/// False for an observer: reads everything, commands nothing.
export const operator = signal(true);
export const injections = signal([]);
/// As GET /api/alarms has them, and when somebody acknowledged all of it; kept by the station.
export const alarms = signal([]);
export const seen_until = signal(null);
/// {holder, asking, at_ms}: who commands, as the station says; null while that is not known.
export const authority = signal(null);
/// {id, from} of the flight that is flown now, and all that the archive has.
export const flight = signal(null);
export const flights = signal([]);
/// {pages, operators, observers}: who has a page open at the station; null while it has not said. And which of them is this one.
export const present = signal(null);
export const own_client = signal('');
/// The station was replaced by one of another version under this page: {page, station}.
export const other_version = signal(null);
/// [{name, text, t, who}]: telecommands that somebody keeps at the station, as lines of `hirosco tc`.
export const kept_stacks = signal([]);
/// Counts batches of values; a view that draws at telemetry rate reads it.
export const fast = signal(0);
/// The same at 5 Hz, for numbers that people read, and for ages.
export const slow = signal(0);

let slow_due = false, status_due = null, picture_ms = -Infinity;
function tell_slow() {
  slow_due = false;
  batch(() => {
    if (status_due) status.value = status_due;
    status_due = null;
    slow.value = slow.peek() + 1;
  });
}
/// What is due is told with a picture of the robot that is drawn now: a page that changes at two moments is put together twice.
export function with_picture() {
  picture_ms = performance.now();
  if (slow_due) tell_slow();
}
/// Who is in which state: what is news at once, while ages and counters of a status wait for the other numbers.
const news_of = ({mode, link: now, subsystems = []}) => [mode, now?.connected, ...subsystems.map(({state, configuration, inhibited}) => [state, configuration, inhibited])].join();
function take_status(message) {
  status_due = message;
  if (status.value && performance.now() - picture_ms < pictures_ms && news_of(status.value) === news_of(message)) return;
  status.value = message;
  status_due = null;
}
function slow_tick() {
  if (document.hidden) return;
  if (!slow_due && performance.now() - picture_ms < pictures_ms) slow_due = true;
  else tell_slow();
}

/// NAME -> {v, t}; v is a number, true or false, or words. Not a signal: read it after `fast` or `slow`.
export const values = new Map();
const value_listeners = new Set();
/// Calls `listener(set)` with each batch of values; returns what ends it.
export function on_values(listener) {
  value_listeners.add(listener);
  return () => value_listeners.delete(listener);
}

const clock = {t: NaN, at_ms: 0};
/// On-board time now, as well as the ground can know it.
export function now_s() {
  const speed = replay.value ? (replay.value.state === 'playing' ? replay.value.speed ?? 1 : 0) : 1;
  return clock.t + speed * (performance.now() - clock.at_ms) / 1000;
}
/// Time of the newest message.
export const newest_s = () => clock.t;

function heard(t) {
  if (!Number.isFinite(t)) return;
  if (!(t < clock.t) || clock.t - t > 5 || replay.value) {
    clock.t = t;
    clock.at_ms = performance.now();
  }
}

export const subsystem_of = (name) => mission.value?.subsystems.find((subsystem) => subsystem.name === name);
export const status_of = (name) => status.value?.subsystems?.find((subsystem) => subsystem.name === name);
export const mode_of = computed(() => {
  const mode = status.value?.mode;
  const known = mission.value?.modes ?? [];
  return (known.find((one) => one.id === mode || one.name === mode) ?? {name: mode === undefined || mode === null ? 'unknown' : String(mode)});
});

/// NAME -> {name, type, unit, min, max, enumeration, period_s, subsystem}
export const columns = computed(() => {
  const found = new Map();
  for (const subsystem of mission.value?.subsystems ?? []) {
    for (const structure of subsystem.housekeeping ?? []) {
      for (const column of structure.columns) {
        const name = column.name.startsWith(`${subsystem.name}.`) ? column.name : `${subsystem.name}.${column.name}`;
        const known = found.get(name);
        if (known && known.period_s <= structure.period_s) continue;
        found.set(name, {...column, name, subsystem: subsystem.name, period_s: structure.period_s, sid: structure.sid});
      }
    }
  }
  return found;
});

/// Age and whether it is too old to be believed: three periods of its structure, two seconds at least.
export function freshness(name) {
  const value = values.get(name);
  if (!value) return {age_s: Infinity, stale: true};
  const age_s = now_s() - value.t;
  const period_s = columns.value.get(name)?.period_s ?? 1;
  return {age_s, stale: age_s > Math.max(2, 3 * period_s) * Math.max(1, replay.value?.speed ?? 1)};
}

/// By the browser's own clock: when the gateway said anything, and when the newest packet of the spacecraft came. Its last word on
/// how old that is does not grow when the gateway, or a tunnel to it, stands still.
let message_ms = -Infinity, packet_ms = -Infinity;
const silent_s = 2;
function take_age(age_s) {
  if (Number.isFinite(age_s)) packet_ms = Math.max(packet_ms, performance.now() - 1000 * age_s);
}

export const link = computed(() => {
  slow.value;
  if (!gateway.value.connected) return {state: 'gateway', age_s: (performance.now() - gateway.value.since_ms) / 1000};
  const reported = status.value?.link;
  if (!reported) return {state: 'waiting', age_s: Infinity};
  const unheard_s = (performance.now() - message_ms) / 1000;
  const age_s = Math.max(unheard_s, (performance.now() - packet_ms) / 1000);
  const silent = unheard_s > silent_s || (reported.connected && age_s > silent_s);
  return {state: silent ? 'silent' : reported.connected ? 'up' : 'down', age_s,
    rx: reported.rx, tx: reported.tx, lost: reported.lost ?? 0, damaged: reported.damaged ?? 0,
    archive_failures: reported.archive_failures ?? 0};
});

const counted = (list) => {
  const found = {high: 0, medium: 0, low: 0, info: 0};
  for (const {severity} of list) if (severity in found) ++found[severity];
  return found;
};
export const counts = computed(() => counted(events.value));
/// Alarms that call somebody: neither acknowledged nor shelved.
export const calling = computed(() => counted(alarms.value.filter((one) => one.calls)));

const number_of = (value) => value === 'NaN' ? NaN : value === 'Infinity' ? Infinity : value === '-Infinity' ? -Infinity : value;

function take_values(set, t) {
  for (const [name, value] of Object.entries(set)) {
    const [v, at] = Array.isArray(value) ? value : [value.v, value.t];
    values.set(name, {v: columns.value.get(name)?.type === 'TEXT' ? v : number_of(v), t: at ?? t});
  }
  for (const listener of value_listeners) listener(set);
}

/// One entry for each telecommand with its chain of verdicts, from reports in any order.
export function with_report(list, report) {
  const {type, stage, code, reason, t, reports, ...head} = report;
  const same = (one) => one.id === head.id;
  const before = list.find(same);
  const chain = [...(before?.stages ?? [])];
  for (const one of reports ?? [{stage, code, reason, t}]) {
    if (one.stage && !chain.some((known) => known.stage === one.stage && known.t === one.t)) chain.push(one);
  }
  const known = Object.fromEntries(Object.entries(head).filter(([, value]) => value !== undefined && value !== null));
  const entry = {...before, ...known, t: Math.min(before?.t ?? Infinity, t ?? Infinity), stages: chain};
  return before ? list.map((one) => same(one) ? entry : one) : [entry, ...list].slice(0, most_commands);
}

export const outcome_of = (command) => {
  const stages = command.stages ?? [];
  const failed = stages.find((one) => one.stage === 'failed' || one.stage?.endsWith('failed'));
  if (failed) return {stage: 'failed', code: failed.code, reason: failed.reason};
  for (const stage of ['completed', 'progress', 'started', 'accepted', 'sent']) {
    if (stages.some((one) => one.stage === stage)) return {stage};
  }
  return {stage: 'sent'};
};

let mission_text = '';
let own_version = null;
let batches = 0;

/// A key for what a browser lists; archive rows and messages of the same event must agree.
const event_key = (event) => `${event.t}/${event.apid ?? event.subsystem}/${event.id}/${event.text}`;

function take(list) {
  message_ms = performance.now();
  const fresh_events = [];
  let reports = commands.value;
  let newest_status = null;
  let values_came = false;
  for (const message of list) {
    if (message.type !== 'hello' && message.type !== 'replay' && Boolean(message.replay) !== (replay.value !== null)) continue;
    if (message.type === 'hello') {
      // This page came from the station that was there first.
      own_version ??= message.version;
      other_version.value = message.version === own_version ? null : {page: own_version, station: message.version};
      introduce(message.client);
      own_client.value = String(message.client ?? '');
      operator.value = message.operator !== false;
      if (message.authority) take_authority(message.authority);
      if (message.flight) take_flight(message.flight);
    }
    if (message.type === 'authority') take_authority(message);
    if (message.type === 'alarm') alarms.value = [message, ...alarms.value.filter((one) => one.id !== message.id || one.apid !== message.apid)];
    if (message.type === 'alarms') take_alarms(message);
    if (message.type === 'stacks') kept_stacks.value = message.stacks;
    if (message.type === 'present') present.value = message;
    if (message.type === 'notes') flights.value = flights.value.map((one) => one.id === message.flight ? {...one, notes: message.notes} : one);
    if (message.type === 'flight' && take_flight(message)) begin_anew();
    if (message.type === 'values') {
      heard(message.t);
      take_values(message.set, message.t);
      values_came = true;
    } else if (message.type === 'status') {
      heard(message.t);
      take_age(message.link?.age_s);
      newest_status = message;
    } else if (message.type === 'event') {
      fresh_events.push({...message, key: event_key(message)});
    } else if (message.type === 'command') {
      reports = with_report(reports, message);
    } else if (message.type === 'gap') {
      gaps.value = [...gaps.value.slice(1 - most_gaps), {from: message.from, to: message.to}];
    } else if (message.type === 'filled') {
      gaps.value = gaps.value.filter((gap) => gap.from < message.from || gap.to > message.to);
      ++filled.value;
      fetch_present();
    } else if (message.type === 'fault') {
      injections.value = [message, ...injections.value].slice(0, 50);
    } else if (message.type === 'replay' && message.state !== 'live') {
      if (replay.value) {
        replay.value = {...replay.value, ...message};
        heard(message.at);
      }
    }
  }
  batch(() => {
    if (newest_status) take_status(newest_status);
    if (values_came) fast.value = ++batches;
    if (fresh_events.length) events.value = [...fresh_events.reverse(), ...events.value].slice(0, most_events);
    if (reports !== commands.value) commands.value = reports;
  });
}

const take_authority = ({holder, asking}) => { authority.value = {holder, asking, at_ms: performance.now()}; };
function take_alarms(answer) {
  alarms.value = answer.alarms ?? [];
  seen_until.value = answer.seen_until ?? null;
}
/// True when it is another one than before.
function take_flight({id, from}) {
  const before = flight.value;
  if (id) flight.value = {id, from};
  return Boolean(before && id && before.id !== id);
}
/// Another flight: nothing of the one before stays in the page.
function begin_anew() {
  batch(() => {
    if (!replay.value) forget_time();
    injections.value = [];
    gaps.value = [];
    alarms.value = [];
    seen_until.value = null;
  });
  fetch_present();
}

const rows = (answer, name) => Array.isArray(answer) ? answer : answer?.[name] ?? [];

const refused = 'The gateway refuses this page: open the URL that `hirosco run` printed last, with its token.';

/// When the flight began that flew at `t`; undefined where nobody knows.
export const began_before = (t) => flights.value.find((one) => one.from <= t)?.from;

/// What happened in this flight, or in the one that is replayed, before the page came, so that it opens with a past.
async function fetch_past(until) {
  const from = until === undefined ? flight.value?.from : began_before(until);
  const [event_rows, command_rows] = await Promise.all([
    get('/api/events', {limit: 500, from, to: until}).catch(() => []), get('/api/commands', {limit: 100, from, to: until}).catch(() => [])]);
  const past = rows(event_rows, 'events').map((event) => ({...event, key: event_key(event)}));
  past.sort((a, b) => b.t - a.t);
  let reports = commands.value;
  for (const row of rows(command_rows, 'commands').toSorted((a, b) => a.t - b.t)) reports = with_report(reports, row);
  batch(() => {
    const known = new Set(past.map((event) => event.key));
    events.value = [...events.value.filter((event) => !known.has(event.key)), ...past]
        .sort((a, b) => b.t - a.t).slice(0, most_events);
    commands.value = reports.toSorted((a, b) => b.t - a.t);
  });
}

let fetching = null;
/// One at a time; who asks while one is under way gets the past once more, for what came meanwhile.
function fetch_present() {
  if (fetching) return fetching.then(() => fetch_past(replay.value?.at));
  fetching = really_fetch_present().finally(() => { fetching = null; });
  return fetching;
}

async function really_fetch_present() {
  try {
    // The gateway may be another one than before, with other descriptors.
    const found = await get('/api/mission');
    const text = JSON.stringify(found);
    if (text !== mission_text) {
      mission_text = text;
      mission.value = found;
    }
    const {values: set, ...rest} = await get('/api/status');
    if (!replay.value) {
      heard(rest.t);
      message_ms = performance.now();
      take_age(rest.link?.age_s);
      batch(() => {
        status.value = rest;
        take_values(set ?? {}, rest.t);
        fast.value = ++batches;
      });
    }
    problem.value = '';
    const [alarm_rows, now_commands, known_flights] = await Promise.all(['alarms', 'authority', 'flights'].map((name) => get(`/api/${name}`).catch(() => null)));
    if (alarm_rows) take_alarms(alarm_rows);
    if (now_commands) take_authority(now_commands);
    if (known_flights) {
      flights.value = known_flights.flights;
      if (flights.value[0]) take_flight(flights.value[0]);
    }
    await fetch_past(replay.value?.at);
  } catch (error) {
    problem.value = error.status === 401 || error.status === 403 ? refused : error.status === 0 ? '' : String(error.message);
    if (error.status !== 401) setTimeout(() => gateway.value.connected && fetch_present(), 1000);
  }
}

const worker = new Worker(new URL('feed_worker.js', document.baseURI), {type: 'module'});
export const send_to_gateway = (message) => worker.postMessage({kind: 'send', message});

const begun_ms = [];
const taken = when_through(() => worker.postMessage({kind: 'taken', took_ms: performance.now() - begun_ms.shift()}));
/// Tells the worker when what the batch brought about has been rendered, and how long all of it took.
function take_batch(list) {
  begun_ms.push(performance.now());
  try {
    take(list);
  } finally {
    taken.soon();
  }
}

worker.onmessage = ({data}) => {
  if (data.kind === 'messages') take_batch(data.list);
  if (data.kind === 'open') {
    gateway.value = {connected: true, since_ms: performance.now()};
    if (replay.value) send_to_gateway({type: 'replay', at: now_s(), speed: replay.value.speed});
    fetch_present();
  }
  if (data.kind === 'closed') {
    if (gateway.value.connected) gateway.value = {connected: false, since_ms: performance.now()};
    // A refused WebSocket does not say why; an answer does.
    get('/api/status').catch((error) => { if (error.status === 401 || error.status === 403) problem.value = refused; });
  }
};

export function start() {
  const url = new URL('ws', document.baseURI);
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  url.searchParams.set('token', token());
  url.searchParams.set('seat', seat);
  worker.postMessage({kind: 'connect', url: url.href});
  setInterval(slow_tick, slow_period_ms);
  // Without an answer there is no socket either: say why.
  fetch_present();
}

function forget_time() {
  batch(() => {
    values.clear();
    events.value = [];
    commands.value = [];
    status.value = status_due = null;
    clock.t = NaN;
  });
}

/// The archive from `at` on takes the place of the telemetry, in every view.
export function replay_from(at, speed = replay.value?.speed ?? 1) {
  if (!replay.value || at < now_s()) forget_time();
  replay.value = {at, speed, state: 'playing'};
  clock.t = at;
  clock.at_ms = performance.now();
  send_to_gateway({type: 'replay', at, speed});
  fetch_past(at);
}

/// The address of what is shown now, as it is now: whoever opens it in a page of this station sees it as a replay. No token is in it.
export function moment_link() {
  const [path, query = ''] = location.hash.split('?');
  const words = [...query.split('&').filter((one) => one && !one.startsWith('at=')), `at=${now_s().toFixed(3)}`];
  return `${location.origin}${location.pathname}${path || '#/overview'}?${words.join('&')}`;
}

export function live() {
  if (!replay.value) return;
  replay.value = null;
  forget_time();
  send_to_gateway({type: 'live'});
  fetch_present();
}

effect(() => document.body.classList.toggle('replaying', replay.value !== null));
