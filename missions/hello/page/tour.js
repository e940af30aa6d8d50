// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Where the demonstrator's tour ends: a mission that the page has never heard of.
export const tour = () => [
  {title: 'A new subsystem', view: '#/help', next_flight: true,
    text: 'docs/guide/writing_a_subsystem.md writes one in a quarter of an hour: a descriptor and a step function. This is the smallest that flies. Its forms, values and plots are here without a word about it in the page.',
    done: () => true},
];
