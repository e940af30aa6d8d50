// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Stacks of telecommands: a list that is built from forms, kept by the station for everybody there, and sent row by row. The first row that
// fails ends it. It goes on when its view is left, and ends with the page.
import {signal} from '@preact/signals';
import {finished, say, send} from '../commanding.js';
import {get} from '../api.js';
import {keep_stack, may_send} from '../people.js';
import {kept_stacks, mission, subsystem_of} from '../store.js';
import {choices_of} from './arguments.js';
import {judged} from './judged.js';
import {most_rows, read_stack, stack_text} from './stack_text.js';

const longest_s = 600;

/// Of everybody at this station: [{name, text, t, who}]. Asked for when the first form is shown; told after that.
export const stacks = () => kept_stacks.value;
let asked_for = false;
export function ask_for_stacks() {
  if (asked_for) return;
  asked_for = true;
  get('/api/stacks').then((answer) => { kept_stacks.value = answer.stacks; }, () => { asked_for = false; });
}
/// The one in front: {name, rows}, rows with the `outcome` of when they were sent last.
export const stack = signal({name: '', rows: []});
/// Which row waits for its verdict, and whether others follow: {at, more} or null.
export const running = signal(null);

const bare = ({subsystem, function: name, texts}) => ({subsystem, function: name, texts});
const set_rows = (rows) => { stack.value = {...stack.value, rows}; };

/// Whether it has room.
export function add_row(row) {
  if (stack.value.rows.length >= most_rows) {
    say(`A stack has ${most_rows} rows at most.`, 'bad');
    return false;
  }
  set_rows([...stack.value.rows, bare(row)]);
  return true;
}
export const take_out = (i) => set_rows(stack.value.rows.filter((_, k) => k !== i));
export function move_row(i, by) {
  const rows = [...stack.value.rows], [row] = rows.splice(i, 1);
  rows.splice(Math.max(0, Math.min(rows.length, i + by)), 0, row);
  set_rows(rows);
}
export const empty = () => { stack.value = {name: '', rows: []}; };
export const rename = (name) => { stack.value = {...stack.value, name: name.slice(0, 40)}; };

export const text_now = () => stack_text(stack.value.name, mission.value.name, stack.value.rows.map((row) => ({...row, values: values_of(row).values ?? row.texts})));
export const is_kept = () => stacks().some((one) => one.name === stack.value.name && one.text === text_now());
export const keep = () => keep_stack(stack.value.name.trim(), text_now());
export const forget = (name) => keep_stack(name, '');
export function open(name) {
  const found = stacks().find((one) => one.name === name);
  if (!found) return;
  const problem = take_text(found.text);
  // Another mission, or a descriptor that has changed since.
  if (problem) say(`The stack ${name}: ${problem}`, 'bad');
  else stack.value = {...stack.value, name};
}

export const action_of = (row) => subsystem_of(row.subsystem)?.functions.find((one) => one.name === row.function);

/// {values} of a row, or {problem}: the station judges it again.
export function values_of(row) {
  const action = action_of(row);
  if (!action) return {problem: `${row.subsystem} has no ${row.function}`};
  const values = {};
  for (const argument of action.arguments ?? []) {
    const choices = choices_of(row.subsystem, action, argument);
    const {value, error} = judged(argument, row.texts[argument.name] ?? argument.default ?? (choices.length ? String(choices[0].value) : ''));
    if (error) return {problem: `${argument.name}: ${error}`};
    values[argument.name] = value;
  }
  return {values};
}

/// Rows of lines of `hirosco tc` take the place of those that stand there; what is wrong, as words.
export function take_text(text) {
  const {rows, problem} = read_stack(text, (subsystem, name) => {
    const same = (one, other) => one.toLowerCase() === other.toLowerCase();
    const known = mission.value.subsystems.find((one) => same(one.name, subsystem)), action = known?.functions.find((one) => same(one.name, name));
    if (!known) return `there is no subsystem ${subsystem}`;
    if (!action) return `${known.name} has no telecommand ${name}`;
    return {subsystem: known.name, action: {...action, arguments: action.arguments ?? []}, choices: (argument) => choices_of(known.name, action, argument)};
  });
  if (problem) return problem;
  for (const [i, row] of rows.entries()) {
    const wrong = values_of(row).problem;
    if (wrong) return `telecommand ${i + 1}, ${row.function}: ${wrong}`;
  }
  set_rows(rows);
  return '';
}

function told(i, outcome) {
  set_rows(stack.value.rows.map((row, k) => k === i ? {...row, outcome} : row));
  return outcome;
}

async function send_row(i) {
  const row = stack.value.rows[i], {values, problem} = values_of(row);
  if (problem) return told(i, {stage: 'failed', reason: problem});
  if (!may_send(action_of(row))) return told(i, {stage: 'failed', reason: 'this page does not command'});
  told(i, {stage: 'sent'});
  try {
    return told(i, await finished(await send(row.subsystem, row.function, values, Boolean(action_of(row).confirm)), longest_s));
  } catch (error) {
    return told(i, {stage: 'failed', reason: error.message});
  }
}

/// From row `from` on; with `more` false that one alone. What stood there of before is forgotten from there on.
export async function run(from, more = true) {
  if (running.value) return;
  set_rows(stack.value.rows.map((row, i) => i >= from && (more || i === from) ? bare(row) : row));
  for (let i = from; i < stack.value.rows.length; ++i) {
    running.value = {at: i, more};
    const {stage, reason} = await send_row(i);
    if (stage !== 'completed') say(`${stack.value.rows[i].function}, row ${i + 1} of the stack: ${reason ?? stage}`, 'bad');
    if (stage !== 'completed' || !running.value.more) break;
  }
  running.value = null;
}

/// The row that was sent goes on; no other follows.
export const halt = () => { if (running.value) running.value = {...running.value, more: false}; };
