// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The views that nobody opens first: a chunk of their own, that comes when the robot moves.
export {Commands} from './commands.js';
export {Help} from './help.js';
export {Links} from './links.js';
export {Plots} from './plots.js';
export {Subsystems} from './subsystems.js';
export {Timeline} from './timeline.js';
