// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Telecommands that somebody keeps at hand in this browser.
import {signal} from '@preact/signals';
import {mission} from '../store.js';

const kept = 'hirosco-favourites', most = 24;

/// [{mission, subsystem, function, texts}]: texts as they stand in the form.
const all = signal(JSON.parse(localStorage.getItem(kept) ?? '[]'));
export const favourites = () => all.value.filter((one) => one.mission === mission.value?.name);
const same = (one, other) => one.subsystem === other.subsystem && one.function === other.function && JSON.stringify(one.texts) === JSON.stringify(other.texts);
export const is_favourite = (one) => favourites().some((other) => same(one, other));

export function toggle_favourite(one) {
  const mine = {...one, mission: mission.value.name};
  all.value = is_favourite(one) ? all.value.filter((other) => other.mission !== mine.mission || !same(one, other)) : [mine, ...all.value].slice(0, most);
  localStorage.setItem(kept, JSON.stringify(all.value));
}

export const favourite_text = ({function: name, texts}) => `${name} ${Object.values(texts).join(' ')}`.trim();
