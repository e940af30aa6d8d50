// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// How a telecommand is written in a terminal and in Python.

const for_shell = (word) => /^[\w=.,:+-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
const listed = (value) => Array.isArray(value) ? value.join(',') : String(value);

/// As the terminal has it; arguments by name, so that their order does not matter.
export const as_tc = (subsystem, name, values) =>
  ['hirosco', 'tc', subsystem, name, ...Object.entries(values).map(([argument, value]) => for_shell(`${argument}=${listed(value)}`))].join(' ');

const python_value = (value) => Array.isArray(value) ? `[${value.map(python_value).join(', ')}]` : typeof value === 'string' ? JSON.stringify(value) : String(value);
/// As a line for the client that `hirosco export python` makes: its names are those of the descriptor in small letters.
export const as_python = (subsystem, name, values) =>
  `craft.${subsystem.toLowerCase()}.${name.toLowerCase()}(${Object.entries(values).map(([argument, value]) => `${argument.toLowerCase()}=${python_value(value)}`).join(', ')})`;
