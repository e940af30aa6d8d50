// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A stack of telecommands as a script of the shell: a line of `hirosco tc` each, which ends at the first that fails. Read back from it, or
// from any lines of `hirosco tc` that somebody has.
import {as_tc} from './written.js';

export const most_rows = 50;
const most_characters = 20000;

/// `rows`: [{subsystem, function, values}].
export function stack_text(name, mission, rows) {
  const title = `${name || 'A stack'} of ${mission}`.replaceAll(/\s+/g, ' ');
  return ['#!/bin/sh', `# ${title}: ends at the first telecommand that fails`, 'set -e', ...rows.map((row) => as_tc(row.subsystem, row.function, row.values)), ''].join('\n');
}

/// The words of a line, as a shell has them where nothing is expanded; null where a quote is not closed.
export function words_of(line) {
  const words = [];
  let word = null, quote = '';
  for (let i = 0; i < line.length; ++i) {
    const letter = line[i];
    if (quote) {
      if (letter === quote) quote = '';
      else if (letter === '\\' && quote === '"' && '"\\$`'.includes(line[i + 1])) word += line[++i];
      else word += letter;
    } else if (letter === "'" || letter === '"') {
      quote = letter;
      word ??= '';
    } else if (letter === '\\' && i + 1 < line.length) {
      word = (word ?? '') + line[++i];
    } else if (/\s/.test(letter)) {
      if (word !== null) words.push(word);
      word = null;
    } else if (letter === '#' && word === null) {
      break;
    } else {
      word = (word ?? '') + letter;
    }
  }
  if (word !== null) words.push(word);
  return quote ? null : words;
}

const plain = (text) => text.toLowerCase().replaceAll(/[^a-z0-9]/g, '');
const switches = {on: '1', off: '0'};

/// As it stands in the form: names of values by their numbers, of arrays blanks between them.
function form_text(argument, text, choices) {
  if (argument.type === 'TEXT') return text;
  const known = choices.find((one) => plain(String(one.name)) === plain(text));
  return known ? String(known.value) : switches[text.toLowerCase()] ?? ((argument.count ?? 1) > 1 ? text.replaceAll(',', ' ') : text);
}

/// {rows: [{subsystem, function, texts}]} or {problem}: which line, and why. `find(subsystem, function)`: {subsystem, action, choices(argument)}
/// or what there is instead, as words.
export function read_stack(text, find) {
  if (text.length > most_characters) return {problem: `longer than ${most_characters} characters`};
  const rows = [];
  for (const [i, line] of text.split('\n').entries()) {
    const wrong = (why) => ({problem: `line ${i + 1}: ${why}`});
    let words = words_of(line);
    if (!words) return wrong('a quote is not closed');
    if (!words.length || words.join(' ') === 'set -e') continue;
    if (/(^|\/)hirosco$/.test(words[0]) && words[1] === 'tc') words = words.slice(2);
    if (words.length < 2) return wrong(`"${line.trim().slice(0, 40)}" is no line of "hirosco tc SUBSYSTEM FUNCTION ARGUMENT..."`);
    const found = find(words[0], words[1]);
    if (typeof found === 'string') return wrong(found);
    const {subsystem, action, choices} = found, texts = {};
    let next = 0;
    for (const one of words.slice(2)) {
      const [, before, after] = /^(\w+)=(.*)$/s.exec(one) ?? [];
      const named = before === undefined ? null : action.arguments.find((known) => known.name.toLowerCase() === before.toLowerCase());
      const argument = named ?? action.arguments[next++];
      if (!argument) return wrong(`${action.name} has ${action.arguments.length} argument${action.arguments.length === 1 ? '' : 's'}, and "${one.slice(0, 40)}" is none of them`);
      texts[argument.name] = form_text(argument, named ? after : one, choices(argument));
    }
    if (rows.length === most_rows) return wrong(`more than ${most_rows} telecommands`);
    rows.push({subsystem, function: action.name, texts});
  }
  return {rows};
}
