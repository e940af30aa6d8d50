// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
export const tour = ({values}) => [
  {title: 'Dim the lamp', view: '#/commands/LAMP/DIM', text: 'DIM 0.5 halves what is seen of it.',
    done: () => (values.get('LAMP.CUR_VALUES.BRIGHTNESS')?.v ?? 0) > 0},
];
