// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// An array that leads joints, one row for each: its name, its own range with where it stands, where it is wanted by a slider or as a number.
import {useState} from 'preact/hooks';
import {fixed_text} from '../format.js';
import {html} from '../html.js';
import {slow, values} from '../store.js';
import {number_in} from './numbers.js';

const digits = 3;
const within = ({lower, upper}, value) => Math.max(lower, Math.min(upper, value));
/// Rounded, and still in its range.
const rounded = (joint, value) => within(joint, Number(value.toFixed(digits)));
const stands = (joint) => joint.parameter ? values.get(joint.parameter)?.v : undefined;

/// The words of the field as a number for each joint; who has none yet stays where it stands.
function wanted_of(joints, text) {
  const words = String(text ?? '').trim().split(/[\s;]+/).filter(Boolean);
  return joints.map((joint, i) => {
    const typed = Number.parseFloat((words[i] ?? '').replace('−', '-').replace(',', '.')), is = stands(joint);
    return Number.isFinite(typed) ? typed : Number.isFinite(is) ? rounded(joint, is) : rounded(joint, 0);
  });
}

function Track({joint, wanted}) {
  const span = joint.upper - joint.lower, at = (value) => `${100 * (within(joint, value) - joint.lower) / span}%`, is = stands(joint);
  if (!Number.isFinite(is) || !(span > 0)) return null;
  return html`<svg class="stands" aria-hidden="true"><line class="between" x1=${at(is)} x2=${at(wanted)} y1="7.5" y2="7.5" /><line class="is" x1=${at(is)} x2=${at(is)} y1="1" y2="14" /></svg>`;
}

export function JointRows({argument, joints, text, on_text}) {
  slow.value;
  // What is being typed stays while values come: each would draw the number anew.
  const [typing, set_typing] = useState(null);
  const take = (i, typed) => {
    set_typing(null);
    const value = number_in(typed);
    if (Number.isFinite(value)) set(i, value);
  };
  const wanted = wanted_of(joints, text), empty = String(text ?? '').trim() === '';
  const set = (i, value) => on_text(wanted.map((other, k) => k === i ? value : other).join(' '));
  return html`<div class="joints" role="group" aria-label=${`${argument.name} by joints`}>
    ${joints.map((joint, i) => {
      const beyond = wanted[i] < joint.lower || wanted[i] > joint.upper;
      return html`<div class=${`joint ${beyond ? 'wrong' : empty ? 'none' : ''}`} key=${joint.name} title=${`${joint.name}: ${fixed_text(joint.lower, 2)} … ${fixed_text(joint.upper, 2)}`}>
        <span>${joint.name}</span><span class="slide"><${Track} joint=${joint} wanted=${wanted[i]} /><input type="range" data-test=${`slide-${argument.name}-${i}`} aria-label=${`${joint.name} by slider`} min=${joint.lower} max=${joint.upper}
          step="any" value=${within(joint, wanted[i])} onInput=${(event) => set(i, rounded(joint, Number(event.currentTarget.value)))} /></span>
        <input type="text" inputmode="decimal" data-test=${`joint-${argument.name}-${i}`} aria-label=${joint.name} aria-invalid=${beyond} autocomplete="off" value=${typing?.i === i ? typing.text : empty ? '' : String(wanted[i])}
          placeholder=${fixed_text(wanted[i], digits)} onInput=${(event) => set_typing({i, text: event.currentTarget.value})} onChange=${(event) => take(i, event.currentTarget.value)} onBlur=${() => set_typing(null)} />
        ${beyond ? html`<em>beyond its limits, ${fixed_text(joint.lower, 2)} … ${fixed_text(joint.upper, 2)}</em>` : null}</div>`;
    })}
    <p class="all">${joints[0].parameter ? html`<button type="button" class="link" data-test=${`here-${argument.name}`} onClick=${() => on_text(joints.map((joint) => rounded(joint, stands(joint) ?? 0)).join(' '))}>where it stands</button>` : null}
      <button type="button" class="link" onClick=${() => on_text(joints.map((joint) => rounded(joint, 0)).join(' '))}>all at 0</button></p></div>`;
}
