// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What is typed into forms: kept when the view is left, and shown by the robot's ghost.
import {signal} from '@preact/signals';

/// "SUBSYSTEM.FUNCTION" -> {argument: text}
export const kept_texts = signal({});
/// The form in front: {subsystem, action, values, numbers}; values null while it is empty or wrong, numbers as they stand there, wrong or not,
/// and null while nobody has touched it.
export const typed = signal(null);
/// What the robot's picture says of that goal: {subsystem, action, wrong}, `wrong` empty where nothing is in its way; null without a picture.
export const goal_says = signal(null);
export function fill_form(subsystem, action, texts) {
  const key = `${subsystem}.${action}`;
  kept_texts.value = {...kept_texts.value, [key]: {...kept_texts.value[key], ...texts}};
}
