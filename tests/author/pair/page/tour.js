// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
export const tour = ({fault, events}) => [
  {title: 'Unplug the joystick', view: '#/subsystems/MANIPULATOR', text: 'Both go down together: they are linked.',
    act: ['Unplug', () => fault('joystick', 'unplug')],
    done: () => events.value.some((one) => one.name === 'JOYSTICK_LOST')},
];
