// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
export const tour = ({values}) => [
  {title: 'Move the joint', view: '#/commands/HELLO/MOVE_TO', text: 'MOVE_TO 1 turns it to 1 rad, slowly.',
    done: () => (values.get('HELLO.CUR_VALUES.POSITION')?.v ?? 0) > 0.5},
];
