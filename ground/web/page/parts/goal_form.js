// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The goal of a motion, put into the form of the telecommand that leads there.
import {signal} from '@preact/signals';
import {values} from '../store.js';
import {goal_texts} from './numbers.js';
import {fill_form} from './typed.js';

/// The form that is to be in front: {subsystem, action}; who shows it takes it.
export const wanted_form = signal(null);

export const fill_goal = (about, angles) => fill_form(about.subsystem, about.goal.function, goal_texts(about.goal, angles));

/// A goal where the robot stands, to be dragged from there; false where nobody knows how it stands.
export function goal_where_it_stands(about) {
  const angles = Object.fromEntries(Object.keys(about.goal.joints).map((joint) => [joint, values.get(about.joints[joint])?.v]));
  if (!Object.values(angles).every(Number.isFinite)) return false;
  wanted_form.value = {subsystem: about.subsystem, action: about.goal.function};
  fill_goal(about, angles);
  return true;
}
