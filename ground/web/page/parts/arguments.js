// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {brief_text, state_text} from '../format.js';

const argument_text = (value) => typeof value === 'number' ? brief_text(value) : state_text(String(value));
/// The arguments of a telecommand with their names, in the order in which they were told.
export const arguments_text = (command) => Object.entries(command.arguments ?? {}).map(([name, value]) => `${name} ${argument_text(value)}`).join(', ');
