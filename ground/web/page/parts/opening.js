// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A page that opens with the robot in it shows who is in which state at once, the robot next, and what else there is when that has been seen to
// move: all at once, plots and forms would take the processor from it for half a second.
import {signal} from '@preact/signals';
import {opens_with_robot, scene_of_mission} from './scene_file.js';

const patience_ms = 1500;

/// Whether everything may be there.
export const opened = signal(!opens_with_robot);
export const open = () => { opened.value = true; };
/// What stands in it comes when everything may be there.
export const Later = ({children}) => opened.value ? children : null;

scene_of_mission.subscribe((scene) => { if (scene === null) open(); });
setTimeout(open, patience_ms);
