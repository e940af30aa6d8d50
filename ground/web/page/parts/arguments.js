// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {brief_text, state_text} from '../format.js';
import {mission, subsystem_of} from '../store.js';

/// The mission knows more names for values than a descriptor: modes, links, configurations.
export function choices_of(subsystem, action, argument) {
  if ((argument.count ?? 1) > 1) return [];
  if (argument.enumeration?.length) return argument.enumeration;
  const known = mission.value;
  const named = (list, label = (one) => one.name) => list?.map((one) => ({value: one.id, name: label(one)}));
  if (argument.name === 'MODE' && (action.name === 'SET_MODE' || action.name === 'ENTER_MODE')) return named(known?.modes);
  if (argument.name === 'LINK') return named(known?.links, (one) => `${one.id}: ${one.from} → ${one.to}`);
  if (argument.name === 'CONFIGURATION' && action.name === 'CONFIGURE') return named(subsystem_of(subsystem)?.configurations);
  if (argument.name === 'STATE' && action.name === 'SET_STATE') {
    return subsystem_of(subsystem)?.states?.map((name, value) => ({value, name: state_text(name)}));
  }
  return [];
}

/// The arguments of a telecommand with their names, in the order of its descriptor; values by their names, where they have some.
export function arguments_text(command) {
  const action = subsystem_of(command.subsystem)?.functions.find((one) => one.name === command.function);
  const order = (action?.arguments ?? []).map((one) => one.name);
  const text = ([name, value]) => {
    const argument = {...action?.arguments.find((one) => one.name === name), name};
    const named = typeof value === 'number' ? choices_of(command.subsystem, action ?? {}, argument).find((one) => one.value === value) : null;
    return `${name} ${named ? state_text(named.name) : typeof value === 'number' ? brief_text(value) : state_text([value].flat().map((one) => typeof one === 'number' ? brief_text(one) : String(one)).join(' '))}`;
  };
  return Object.entries(command.arguments ?? {}).toSorted(([a], [b]) => order.indexOf(a) - order.indexOf(b)).map(text).join(', ');
}
