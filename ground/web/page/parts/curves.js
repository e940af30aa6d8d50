// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Names of curves, as they stand in the address of a plot: a parameter, `NAME@3` for the same in flight 3 of the archive, `=EXPRESSION` for
// what is reckoned of them.
import {signal} from '@preact/signals';
import {columns, flights} from '../store.js';
import {parse} from './expression.js';

/// What the robot's picture has as one number of several parameters, by the expression that says so: =EXPRESSION -> {subsystem, words}.
export const pictured = signal(new Map());
export const is_reckoned = (name) => name.startsWith('=');
/// [parameter, the flight's number or null].
export function of_flight(name) {
  const found = is_reckoned(name) ? null : /^(.*)@(\d+)$/.exec(name);
  return found && !columns.peek().has(name) ? [found[1], Number(found[2])] : [name, null];
}
export const flight_title = (id) => flights.value.find((one) => one.id === id)?.name || `Flight ${id}`;

/// What an expression may be of; throws ExpressionError.
export function program_of(text) {
  const names = columns.peek();
  return parse(text, (name) => {
    const column = names.get(of_flight(name)[0]);
    return column && {unit: column.unit ?? '', words: column.type === 'TEXT' || Boolean(column.enumeration?.length)};
  }, names.keys());
}

let read = new Map(), read_of = null;
/// The same once for each mission, as plots ask for it with every picture; {problem} where it is wrong.
export function reckoned(name) {
  if (read_of !== columns.peek()) [read, read_of] = [new Map(), columns.peek()];
  if (!read.has(name)) {
    let program;
    try {
      program = program_of(name.slice(1));
    } catch (error) {
      program = {inputs: [], unit: '', at: () => NaN, problem: error.message};
    }
    if (read.size > 100) read.clear();
    read.set(name, program);
  }
  return read.get(name);
}

/// As of a parameter: {name, type, unit, …}; undefined where there is none.
export function column_of(name) {
  if (is_reckoned(name)) return columns.value.size ? {name, type: 'DOUBLE', unit: reckoned(name).unit} : undefined;
  return columns.value.get(of_flight(name)[0]);
}

/// The parameters of the present flight that it needs.
export const parameters_of = (name) => [...new Set((is_reckoned(name) ? reckoned(name).inputs : [name]).map((one) => of_flight(one)[0]))];

/// [what stands grey before it, the name].
export function curve_words(name) {
  const known = pictured.value.get(name);
  if (known) return [known.subsystem, known.words];
  if (is_reckoned(name)) return ['', name.slice(1)];
  const [parameter, id] = of_flight(name), [subsystem, ...rest] = parameter.split('.');
  return [id === null ? subsystem : `${flight_title(id)} · ${subsystem}`, rest.join('.') || parameter];
}

/// `name` in another flight; nothing for what is of one already.
export const in_flight = (name, id) => is_reckoned(name) || of_flight(name)[1] !== null ? null : `${name}@${id}`;
