// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What a mission shows of itself: the files of its page/ folder, which the gateway serves below mission/ (docs/adr/0055).
import {asset} from './api.js';

const listed = asset('mission/index.json').then((answer) => answer.json()).catch(() => []);

/// Whether the mission has this file: a page that tried would leave an error in the console for each that it has not.
export const mission_has = (name) => listed.then((names) => names.includes(name));
export const mission_folder = 'mission';
const texts = new Map();
/// A file as text, asked for once: also ahead of who needs it.
export function mission_text(name) {
  if (!texts.has(name)) texts.set(name, asset(`${mission_folder}/${name}`).then((answer) => answer.text()));
  return texts.get(name);
}
export const mission_json = (name) => asset(`${mission_folder}/${name}`).then((answer) => answer.json());
export const mission_code = (name) => import(new URL(`${mission_folder}/${name}`, document.baseURI).href);
