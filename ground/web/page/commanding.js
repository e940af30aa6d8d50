// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Everything that goes up passes here: telecommands by the supervisor, faults by the simulated devices' own sockets.
import {signal} from '@preact/signals';
import {get, post, seat} from './api.js';
import {commands, mission, now_s, outcome_of, replay, status, status_of, subsystem_of, with_report} from './store.js';

/// Short words at the lower edge for what was sent without a form.
export const toasts = signal([]);
let toast_number = 0;
export function say(text, kind = 'info') {
  const one = {number: ++toast_number, text, kind};
  toasts.value = [...toasts.value, one].slice(-4);
  setTimeout(() => { toasts.value = toasts.value.filter((other) => other !== one); }, kind === 'bad' ? 9000 : 4000);
}

export const copy = (text, words) => navigator.clipboard?.writeText(text).then(() => say(words), () => say('the browser does not let this page copy', 'bad'));

const name_kept = 'hirosco-operator';
/// What the others see as sender; the gateway has a name of its own for who gives none.
export const operator_name = signal(localStorage.getItem(name_kept) ?? '');
export function name_operator(name) {
  operator_name.value = name.slice(0, 32);
  localStorage.setItem(name_kept, operator_name.value);
}

/// How this page is told to others.
export const signed = () => ({seat, sender: operator_name.value || undefined});

/// `confirmed`: somebody was asked once more, as the descriptor wants it of some.
export async function send(subsystem, function_name, values = {}, confirmed = false) {
  if (replay.value) throw new Error('This is a replay: telecommands are locked.');
  const answer = await post('/api/commands', {subsystem, function: function_name, arguments: values, ...signed(),
    ...(confirmed ? {confirmed} : {})});
  commands.value = with_report(commands.value, {id: answer.id, subsystem, function: function_name, arguments: values,
    octets: answer.octets, mine: true});
  return answer.id;
}

/// How long the spacecraft took to answer this page last, with both ways there and back, in ms; NaN before.
export const answered_ms = signal(NaN);
export async function preview(subsystem, function_name, values) {
  const asked_ms = performance.now(), answer = await post('/api/commands/preview', {subsystem, function: function_name, arguments: values});
  // Without a link the station answers by itself that nobody knows.
  if (answer.permitted !== null) answered_ms.value = performance.now() - asked_ms;
  return answer;
}

/// Sends and says the outcome in a toast.
export async function send_and_say(subsystem, function_name, values = {}) {
  try {
    const outcome = await finished(await send(subsystem, function_name, values));
    const words = `${subsystem} ${function_name}`;
    if (outcome.stage === 'failed') say(`${words}: ${outcome.reason ?? `code ${outcome.code}`}`, 'bad');
    else say(`${words}: ${outcome.stage}`, 'good');
    return outcome;
  } catch (error) {
    say(`${subsystem} ${function_name}: ${error.message}`, 'bad');
    return {stage: 'failed', reason: error.message};
  }
}

/// Resolves with the outcome of a sent telecommand: completed or failed; what is there after `limit_s` else.
export function finished(id, limit_s = 20) {
  return new Promise((resolve) => {
    let timer = 0;
    let stop = () => {};
    const look = () => {
      const command = commands.value.find((one) => one.id === id);
      const outcome = command ? outcome_of(command) : {stage: 'sent'};
      if (outcome.stage === 'completed' || outcome.stage === 'failed') finish(outcome);
    };
    const finish = (outcome) => {
      clearTimeout(timer);
      stop();
      resolve(outcome);
    };
    timer = setTimeout(() => finish({stage: 'failed', reason: `no verdict within ${limit_s} s`}), limit_s * 1000);
    stop = commands.subscribe(() => queueMicrotask(look));
  });
}

export async function fault(device, line, {quiet = false} = {}) {
  if (replay.value) throw new Error('This is a replay: faults are locked.');
  try {
    const {answer} = await post('/api/faults', {device, line});
    if (!quiet) say(`${device} ${line}: ${answer ?? 'done'}`, 'good');
    return answer;
  } catch (error) {
    if (!quiet) say(`${device} ${line}: ${error.message}`, 'bad');
    throw error;
  }
}

const transient = new Set(['SoftwareInit', 'HardwareInit', 'HardwareDeinit', 'SoftwareDeinit']);
const after_failure = new Set(['SoftwareInit>SoftwareDeinit', 'HardwareInit>HardwareDeinit']);

/// The states passed on the way to `to`, `to` last; null where the command is illegal. The same rule as on board:
/// transient states and the way down from Post-Operational are passed through. Who does not run, null, is started by Offline.
export function route(from, to) {
  if (from === null) return to === 'Offline' ? ['Offline'] : null;
  if (!from || from === to || transient.has(from) || transient.has(to)) return null;
  const edges = (mission.value?.transitions ?? []).filter((edge) => !after_failure.has(`${edge.from}>${edge.to}`));
  const passes = (state) => transient.has(state) || state === 'PostOperational';
  const way = [];
  for (let at = from; way.length < 5;) {
    let next = null;
    for (const edge of edges) {
      if (edge.from !== at) continue;
      if (edge.to === to) {
        next = to;
        break;
      }
      if (passes(edge.to)) next = edge.to;
    }
    if (next === null) return null;
    way.push(next);
    if (next === to) return way;
    at = next;
  }
  return null;
}

export const state_names = ['Offline', 'SoftwareInit', 'HardwareInit', 'PreOperational', 'SafeOperational', 'Operational',
  'ErrorOperational', 'PostOperational', 'HardwareDeinit', 'SoftwareDeinit'];
export const state_name = (state) => typeof state === 'number' ? state_names[state] : state;

export function state_value(name) {
  const listed = subsystem_of('SUPERVISOR')?.states ?? state_names;
  const found = listed.indexOf(name);
  return found >= 0 ? found : state_names.indexOf(name);
}

/// The states to command next, steady ones only.
export const legal_states = (from) => state_names.filter((to) => route(from, to));

const wait_after_step_ms = 250;
const is_done = (step) => ['completed', 'not needed'].includes(step.stage);

/// The bring-up that this page is at: {mode, done, all, text of the present step}; null when it is at none.
export const bringing = signal(null);

/// Sends what brings `mode` up, one after the other; the first refusal ends it. `told(steps)` hears of every change of a step's `stage`;
/// `stopped()` true ends it before the next. Resolves with the steps.
export async function bring_up(mode, tell = () => {}, stopped = () => false) {
  const told = (steps) => {
    const done = steps.filter(is_done).length;
    bringing.value = {mode: mode.name, done, all: steps.length, text: steps.find((step) => !is_done(step))?.text ?? `${mode.name} holds`};
    tell(steps);
  };
  try {
    return await brought_up(mode, told, stopped);
  } finally {
    bringing.value = null;
  }
}

async function brought_up(mode, told, stopped) {
  const began_s = now_s();
  const steps = commissioning_steps(mode).map((step) => ({...step, stage: 'waiting'}));
  for (const step of steps) {
    if (stopped()) break;
    step.stage = step.needed() ? 'sent' : 'not needed';
    told(steps);
    if (step.stage === 'not needed') continue;
    const outcome = await send(step.subsystem, step.function, step.arguments).then(finished)
        .catch((error) => ({stage: 'failed', reason: error.message}));
    Object.assign(step, outcome);
    if (step.stage === 'failed') step.reason = await true_reason(step, began_s);
    told(steps);
    if (step.stage === 'failed') break;
    // The supervisor tells of everybody's states five times a second: the next step asks what is needed still.
    await new Promise((resolve) => setTimeout(resolve, wait_after_step_ms));
  }
  if (steps.some((step) => step.stage === 'failed' || step.stage === 'waiting')) return steps;
  // Every step was taken; who fell meanwhile is told by a later word of the spacecraft only.
  const fell = await fallen_after(mode.commission ?? []);
  if (fell.length) {
    steps.push({text: `${mode.name} holds`, stage: 'failed',
      reason: await true_reason({reason: `${fell.join(' and ')} did not stay where ${mode.name} has them`}, began_s)});
    told(steps);
  }
  return steps;
}

const settled_after_ms = 3000;

/// Members that are not where the mode has them, or inhibited, by what the gateway says from now on; housekeeping comes late by a moment.
function fallen_after(members) {
  const fallen = () => members.filter((member) => !is_on(member.subsystem, member.state) || status_of(member.subsystem)?.inhibited?.length)
      .map((member) => member.subsystem);
  return new Promise((resolve) => {
    const before = status.value;
    let end = () => {};
    const finish = () => {
      clearTimeout(timer);
      end();
      resolve(fallen());
    };
    const timer = setTimeout(finish, settled_after_ms);
    end = status.subscribe((now) => { if (now !== before && !fallen().length) queueMicrotask(finish); });
  });
}

/// What took the network down while it came up says more than that a step is not permitted in the state that this left.
async function true_reason({reason, code}, began_s) {
  await new Promise((resolve) => setTimeout(resolve, wait_after_step_ms));
  const refusal = reason ?? `code ${code}`;
  const story = await get('/api/why').catch(() => null);
  return story?.causes?.length && story.t > began_s ? `${story.title} (${refusal})` : refusal;
}

const is_on = (name, state) => state_name(status_of(name)?.state) === state;

/// The steps that bring a network up, in the order of the supervisor's own commissioning: all to Pre-Operational, their
/// configurations, the links, then all up together. Each is {text, subsystem, function, arguments, needed}.
export function commissioning_steps(mode) {
  const members = mode.commission ?? [];
  const steps = [];
  const add = (text, subsystem, function_name, values, needed = () => true) =>
    steps.push({text, subsystem, function: function_name, arguments: values, needed});
  const permissive = mission.value.modes.find((one) => one.name === 'commissioning') ?? mission.value.modes[0];
  const mode_argument = subsystem_of('SUPERVISOR')?.functions.find((one) => one.name === 'SET_MODE')?.arguments[0]?.name ?? 'MODE';
  const enter = (to) => add(`mode ${to.name}`, 'SUPERVISOR', 'SET_MODE', {[mode_argument]: to.id});
  enter(permissive);
  // Who gives its links back takes down those who need them: a network comes up as a whole.
  const down = new Set(members.filter((member) => !is_on(member.subsystem, member.state) || !configured(member)).map((one) => one.subsystem));
  const ties = mission.value.links.filter((one) => (mode.establish ?? []).includes(one.id));
  for (let size = -1; size !== down.size;) {
    size = down.size;
    for (const {from, to} of ties) if (down.has(from) || down.has(to)) down.add(from).add(to);
  }
  const others = members.filter((member) => down.has(member.subsystem));
  for (const member of others) {
    const from = () => state_name(status_of(member.subsystem)?.state);
    add(`${member.subsystem} started again`, member.subsystem, 'SET_STATE', {STATE: state_value('Offline')}, () => from() === null);
    add(`${member.subsystem} to Safe-Operational`, member.subsystem, 'SET_STATE', {STATE: state_value('SafeOperational')},
      () => from() === 'Operational');
    add(`${member.subsystem} to Post-Operational`, member.subsystem, 'SET_STATE', {STATE: state_value('PostOperational')},
      () => from() === 'SafeOperational' || from() === 'ErrorOperational');
    add(`${member.subsystem} to Pre-Operational`, member.subsystem, 'SET_STATE', {STATE: state_value('PreOperational')},
      () => from() !== 'PreOperational');
  }
  for (const member of others) {
    const configuration = subsystem_of(member.subsystem)?.configurations.find((one) => one.name === member.configuration);
    add(`${member.subsystem} configured as ${member.configuration}`, member.subsystem, 'CONFIGURE',
      {CONFIGURATION: configuration?.id ?? 1});
  }
  for (const id of mode.establish ?? []) {
    const named = mission.value.links.find((one) => one.id === id);
    add(`link ${id} ${named ? `${named.from} → ${named.to}` : ''}`, 'SUPERVISOR', 'LINK', {LINK: id}, () => !link_is_up(id));
  }
  for (const state of ['SafeOperational', 'Operational']) {
    for (const member of others) {
      if (state === 'Operational' && member.state !== 'Operational') continue;
      add(`${member.subsystem} to ${state.replace(/([a-z])([A-Z])/, '$1-$2')}`, member.subsystem, 'SET_STATE',
        {STATE: state_value(state)}, () => !is_on(member.subsystem, state));
    }
  }
  enter(mode);
  return steps;
}

function configured(member) {
  const now = status_of(member.subsystem)?.configuration;
  const known = subsystem_of(member.subsystem)?.configurations ?? [];
  return now === member.configuration || known.find((one) => one.id === now)?.name === member.configuration;
}

export const link_is_up = (id) => link_states().find((one) => one.id === id)?.up === true;
const link_states = () => status.value?.links ?? [];
