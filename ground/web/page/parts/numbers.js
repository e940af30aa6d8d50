// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Numbers in the words of a form, whatever its ranges say of them. Pure.

const number_pattern = /^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$/;
const digits = 3;

/// The number that a word is, with a minus sign or comma of any keyboard; NaN where it is none.
export function number_in(word) {
  const words = String(word ?? '').trim().replace('−', '-').replace(',', '.');
  return number_pattern.test(words) ? Number(words) : NaN;
}

/// One number, or of an array all of them.
export const numbers_in = (text, count) => count > 1 ? String(text ?? '').trim().split(/[\s;]+/).filter(Boolean).map(number_in) : number_in(text);

/// "GOAL[2]": the argument GOAL and its element 2; a name alone has no element.
export function led(words) {
  const [, argument, element] = /^(.*?)(?:\[(\d+)\])?$/.exec(words);
  return {argument, element: element === undefined ? null : Number(element)};
}

/// What it is among the values of a telecommand.
export function led_value(values, words) {
  const {argument, element} = led(words);
  return Number(element === null ? values?.[argument] : values?.[argument]?.[element]);
}

/// {argument: text} that leads the joints of a `goal` of scene.json to these {joint: angle}.
export function goal_texts(goal, angles) {
  const texts = {};
  for (const [joint, words] of Object.entries(goal.joints)) {
    const {argument, element} = led(words), text = String(Number(angles[joint].toFixed(digits)));
    if (element === null) texts[argument] = text;
    else (texts[argument] ??= [])[element] = text;
  }
  return Object.fromEntries(Object.entries(texts).map(([argument, text]) => [argument, [text].flat().join(' ')]));
}
