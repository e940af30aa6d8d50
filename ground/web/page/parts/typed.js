// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What is typed into forms: kept when the view is left, and shown by the robot's ghost.
import {signal} from '@preact/signals';

/// "SUBSYSTEM.FUNCTION" -> {argument: text}
export const kept_texts = signal({});
/// The form in front: {subsystem, action, values, numbers, refused}; values null while it is empty or wrong, numbers as they stand there, wrong or not,
/// and null while nobody has touched it, and once it has been sent and was done. `refused`: so it was sent, and was not done.
export const typed = signal(null);
/// "SUBSYSTEM.FUNCTION" -> number of the telecommand that was sent with what stands in its form still.
export const spent = signal({});
/// What the robot's picture says of that goal: {subsystem, action, wrong}, `wrong` empty where nothing is in its way; null without a picture.
export const goal_says = signal(null);
export const spend = (subsystem, action, id) => { spent.value = {...spent.value, [`${subsystem}.${action}`]: id}; };
export function fill_form(subsystem, action, texts) {
  const key = `${subsystem}.${action}`;
  if (spent.value[key]) spent.value = {...spent.value, [key]: null};
  kept_texts.value = {...kept_texts.value, [key]: {...kept_texts.value[key], ...texts}};
}
