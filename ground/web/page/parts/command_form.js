// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A telecommand from its descriptor: one field for each argument, judged while it is typed, the octets and the supervisor's
// answer to "permitted now?" before sending, the chain of verdicts after.
import {useEffect, useLayoutEffect, useRef, useState} from 'preact/hooks';
import {copy, preview, say, send, send_and_say, state_name} from '../commanding.js';
import {clock_text, hex_text, state_text, unit_text} from '../format.js';
import {html} from '../html.js';
import {commands, mission, mode_of, operator, outcome_of, replay, slow, status_of, subsystem_of, values} from '../store.js';
import {command_is, commander, i_ask, may_send, take_command} from '../people.js';
import {arguments_text, choices_of} from './arguments.js';
import {is_favourite, toggle_favourite} from './favourites.js';
import {JogPad} from './jog_pad.js';
import {jog_of} from './jog_steps.js';
import {JointRows} from './joint_rows.js';
import {mode_wanted} from './mode_menu.js';
import {judged, range_of, range_text} from './judged.js';
import {joints_of} from './robot_file.js';
import {numbers_in} from './numbers.js';
import {scene_of_mission} from './scene_file.js';
import {fill_form, goal_says, kept_texts, spend, spent, typed} from './typed.js';
import {as_python, as_tc} from './written.js';

const first_text = (argument, choices) => {
  if (argument.default !== undefined && argument.default !== null) {
    return new Array(argument.type === 'TEXT' ? 1 : argument.count ?? 1).fill(argument.default).join(' ');
  }
  return choices?.length ? String(choices[0].value) : '';
};

/// The way that a motion has to go: where the parameter stands, where it is wanted, within the range of the argument.
function Way({argument, now, wanted}) {
  slow.value;
  const [low, high] = range_of(argument), is = values.get(now)?.v;
  if (!(high > low) || !Number.isFinite(is)) return null;
  const part = (value) => `${100 * Math.max(0, Math.min(1, (value - low) / (high - low)))}%`;
  return html`<span class="way" aria-hidden="true"><svg><line class="is" x1=${part(is)} x2=${part(is)} y1="2" y2="13" />${Number.isFinite(wanted) ? html`
    <line class="between" x1=${part(is)} x2=${part(wanted)} y1="7.5" y2="7.5" /><circle class="typed" cx=${part(wanted)} cy="7.5" r="4.5" />` : null}</svg></span>`;
}

function Field({subsystem, action, argument, text, on_text, result, focus, now}) {
  const choices = choices_of(subsystem, action, argument);
  const unit = unit_text(argument.unit);
  const field = `field-${argument.name}`;
  const error = result.error && text !== '' ? result.error : null;
  const placeholder = argument.type === 'TEXT' ? `text, at most ${argument.octets} octets` : range_text(argument) || argument.type.toLowerCase();
  const joints = joints_of(subsystem, action.name, argument);
  return html`<label class=${`field ${error ? 'wrong' : ''}`}><span>${argument.name}${unit ? html` <small>${unit}</small>` : null}</span>
    ${argument.type === 'BOOL' && (argument.count ?? 1) === 1 ? html`<input data-test=${field} type="checkbox" checked=${judged(argument, text).value === 1}
        onChange=${(event) => on_text(event.currentTarget.checked ? '1' : '0')} />` :
      choices?.length ? html`<select data-test=${field} value=${text} onChange=${(event) => on_text(event.currentTarget.value)}>
        ${choices.map((one) => html`<option value=${String(one.value)}>${state_text(one.name)}${
          Number.isInteger(one.value) ? ` (${one.value})` : ''}</option>`)}</select>` :
      html`<span class=${joints ? 'in whole' : 'in'}><input data-test=${field} type="text" inputmode=${argument.type === 'TEXT' ? 'text' : 'decimal'} autocomplete="off" spellcheck="false" value=${text}
        aria-invalid=${Boolean(error)} placeholder=${placeholder}
        autofocus=${focus} onInput=${(event) => on_text(event.currentTarget.value)} /><small>${text && argument.type !== 'TEXT' && !joints ? range_text(argument) : ''}</small></span>`}
    <em>${error ?? ''}</em>${now ? html`<${Way} argument=${argument} now=${now} wanted=${result.value} />` : null}</label>
    ${joints ? html`<${JointRows} argument=${argument} joints=${joints} text=${text} on_text=${on_text} />` : null}`;
}

const verdict_words = {sent: 'sent', accepted: 'accepted', started: 'started', progress: 'progress', completed: 'completed',
  failed: 'failed'};

/// sent – accepted – started – completed, with the times between them.
export function VerdictChain({command}) {
  const stages = [...(command.stages ?? [])].sort((a, b) => a.t - b.t);
  const first = stages[0]?.t;
  return html`<ol class="chain">${stages.map((one, i) => html`<li class=${one.stage}>
    <i />${verdict_words[one.stage] ?? one.stage}${i > 0 && one.t - first >= 0 ? html` <small>+${
      one.t - first < 10 ? `${((one.t - first) * 1000).toFixed(0)} ms` : `${(one.t - first).toFixed(1)} s`}</small>` : null}
    ${one.stage === 'failed' ? html` <b>${one.reason ?? ''}${one.code ? ` (code ${one.code})` : ''}</b>` : null}</li>`)}</ol>`;
}

/// Modes that permit a telecommand which the present one refuses.
function modes_that_permit(subsystem, action) {
  return (mission.value?.modes ?? []).filter((mode) => mode.name !== mode_of.value.name && (mode.permits ?? []).some((permit) => [subsystem, '*'].includes(permit.subsystem) &&
    ((permit.functions ?? []).includes(action.name) || (permit.services ?? []).includes(action.service))));
}

const Lock = () => html`<svg viewBox="0 0 12 12" aria-hidden="true"><rect x="1.8" y="5.4" width="8.4" height="5.8" rx="1.2" fill="currentColor" /><path d="M3.7 5.4V3.7a2.3 2.3 0 0 1 4.6 0v1.7" fill="none" stroke="currentColor" stroke-width="1.5" /></svg>`;

/// What the supervisor answers to "now?", and what would make it permit.
function Permission({answer, problem, subsystem, action, brief}) {
  if (problem) return html`<p class="permission none">${problem}</p>`;
  if (!answer) return html`<p class="permission none">asking the supervisor …</p>`;
  if (answer.permitted === null || answer.permitted === undefined) {
    return html`<p class="permission none">supervisor: ${answer.reason ?? 'does not answer'}</p>`;
  }
  if (answer.permitted) return html`<p class="permission yes" data-test="permission">permitted now</p>`;
  const modes = modes_that_permit(subsystem, action).map((mode) => mode.name);
  const states = (action.states ?? []).map(state_text);
  if (brief && !modes.length && !in_wrong_state(subsystem, action)) return null;
  return html`<p class="permission no" data-test="permission">${brief ? null : html`<${Lock} /><b>Not now:</b> ${answer.reason ?? `code ${answer.code}`}.`}
    ${modes.length ? html` Permitted in ${modes.slice(0, 3).join(', ')}${states.length ? `, ${states.join(' or ')}` : ''}.` : states.length ? html` Taken in ${states.join(' and ')}.` : null}
    ${modes.length && operator.value ? html`<button type="button" class="link" data-test="permit-mode" onClick=${() => { mode_wanted.value = modes[0]; }}>Go ${modes[0]} …</button>` : null}
    ${in_wrong_state(subsystem, action) ? html`<a class="link" data-test="permit-state" href=${`#/subsystems/${subsystem}`}>Bring ${subsystem} there …</a>` : null}</p>`;
}

const in_wrong_state = (subsystem, action) => action.states?.length > 0 && !action.states.includes(state_name(status_of(subsystem)?.state));

/// Another page commands: who, and how to get it. What is essential asks nobody.
function Authority({action}) {
  if (!operator.value || action.essential || command_is.value !== 'other') return null;
  return html`<p class="permission no" data-test="not-commanding"><b>${commander.value} commands.</b> <button type="button" class="link" data-test="ask-command" disabled=${i_ask.value}
    onClick=${take_command}>${i_ask.value ? 'asked' : `Ask ${commander.value} for it`}</button></p>`;
}

/// Kept at hand, and as it is written elsewhere.
function Words({subsystem, action, texts, values}) {
  if (!values) return null;
  const one = {subsystem, function: action.name, texts};
  return html`<p class="words_of"><button type="button" class="link" data-test="favourite" aria-pressed=${is_favourite(one)} onClick=${() => toggle_favourite(one)}>${is_favourite(one) ? 'kept at hand ✓' : 'keep at hand'}</button>
    <button type="button" class="link" data-test="to-stack" title="the list at the right is sent row by row" onClick=${() => to_stack(one)}>to the stack</button>
    <button type="button" class="link" data-test="copy-tc" title=${as_tc(subsystem, action.name, values)} onClick=${() => copy(as_tc(subsystem, action.name, values), 'copied for the terminal')}>copy as hirosco tc</button>
    <button type="button" class="link" data-test="copy-python" title=${as_python(subsystem, action.name, values)} onClick=${() => copy(as_python(subsystem, action.name, values), 'copied for Python')}>as Python</button></p>`;
}

/// The stack is of another view, which comes later.
async function to_stack(one) {
  const {add_row} = await import('./stack.js');
  if (add_row(one)) say(`${one.function} is in the stack, under Commands`);
}

const preview_after_ms = 180, confirm_within_ms = 6000;

/// Of those the supervisor judges by mode and state alone, whatever stands in them: it can be asked before anything does.
const judged_as_such = (action) => action.service === 8 ? !['SET_STATE', 'CONFIGURE'].includes(action.name) : action.service >= 128;
/// Values that are no one's, for that question.
function any_values(list) {
  const one = (argument) => argument.type === 'TEXT' ? '' : argument.enumeration?.[0]?.value ?? argument.default ?? Number(Math.max(Number(range_of(argument)[0]), Math.min(0, Number(range_of(argument)[1]))));
  return Object.fromEntries(list.map((argument) => [argument.name, (argument.count ?? 1) > 1 && argument.type !== 'TEXT' ? new Array(argument.count).fill(one(argument)) : one(argument)]));
}

function usePreview(subsystem, action, values) {
  const [answer, set_answer] = useState(null);
  const key = JSON.stringify([subsystem, action.name, values, mode_of.value.name, status_of(subsystem)?.state]);
  useEffect(() => {
    if (!values || replay.value || !operator.value) return set_answer(null);
    let over = false;
    const timer = setTimeout(() => preview(subsystem, action.name, values).then(
      (found) => over || set_answer(found), (error) => over || set_answer({problem: error.message})), preview_after_ms);
    return () => {
      over = true;
      clearTimeout(timer);
    };
  }, [key]);
  return answer;
}

/// The parameters that the arguments of a motion lead, as scene.json has them of its robots: {argument: parameter}.
function led_by(subsystem, action) {
  const robot = scene_of_mission.value?.robots?.find((one) => one.subsystem === subsystem && one.goal?.function === action);
  return Object.fromEntries(Object.entries(robot?.goal.joints ?? {}).map(([joint, argument]) => [argument, robot.joints[joint]]));
}

/// Back into its form, as it was sent.
export function edit(one) {
  const action = subsystem_of(one.subsystem)?.functions.find((known) => known.name === one.function);
  const text = ([name, value]) => [name, String(choices_of(one.subsystem, action ?? {}, {...action?.arguments.find((known) => known.name === name), name}).find((choice) => choice.name === value)?.value ?? [value].flat().join(' '))];
  fill_form(one.subsystem, one.function, Object.fromEntries(Object.entries(one.arguments ?? {}).map(text)));
  location.hash = `#/commands/${one.subsystem}/${one.function}`;
}

/// Once more as it was; what is to be confirmed goes back into its form instead.
export function again(one) {
  const action = subsystem_of(one.subsystem)?.functions.find((known) => known.name === one.function);
  if (!action?.confirm) return send_and_say(one.subsystem, one.function, one.arguments);
  return edit(one);
}

/// What was sent last, to be sent again with one click: its words go back into the form, or at once where it has none.
function Recent({subsystem}) {
  const seen = new Set();
  const list = commands.value.filter((one) => one.subsystem === subsystem && one.function !== '?' && !seen.has(`${one.function} ${arguments_text(one)}`) && seen.add(`${one.function} ${arguments_text(one)}`)).slice(0, 3);
  if (!list.length) return null;
  return html`<ul class="recent">${list.map((one) => html`<li key=${one.id}><b>${one.function} ${arguments_text(one)}</b>${operator.value && !replay.value ? html`<button type="button"
    onClick=${() => again(one)}>again</button>` : html`<span />`}<span>${outcome_of(one).stage === 'failed' ? 'refused' : outcome_of(one).stage}</span><span>${clock_text(one.t, 0)}</span></li>`)}</ul>`;
}

export function CommandForm({subsystem, action, given = {}, focus = false, recent = false}) {
  const key = `${subsystem}.${action.name}`;
  const texts = kept_texts.value[key] ?? {};
  const [sent, set_sent] = useState(null);
  const [problem, set_problem] = useState('');
  const [asked, set_asked] = useState(false);
  const form = useRef(null);
  const list = action.arguments ?? [];
  const text_of = (argument) => texts[argument.name] ?? given[argument.name] ??
    first_text(argument, choices_of(subsystem, action, argument));
  const results = list.map((argument) => judged(argument, text_of(argument)));
  const wrong = results.filter((result) => result.error).length, mistyped = results.findIndex((result, i) => result.error && text_of(list[i]) !== '');
  const sent_values = wrong ? null : Object.fromEntries(list.map((argument, i) => [argument.name, results[i].value]));
  const answer = usePreview(subsystem, action, sent_values ?? (judged_as_such(action) ? any_values(list) : null));
  const refused = answer?.permitted === false;
  const mine = commands.value.find((one) => one.id === sent), answered = Boolean(mine) && spent.value[key] === sent && !problem;
  const now = led_by(subsystem, action.name), jog = jog_of(action);
  // The spacecraft permits it all the same: what it meets, it presses until a limit stops it.
  const said = goal_says.value, in_its_way = sent_values && said?.subsystem === subsystem && said.action === action.name ? said.wrong : '';
  const was_sent = commands.value.find((one) => one.id === spent.value[key]), became = was_sent ? outcome_of(was_sent).stage : '';
  useEffect(() => {
    const touched = Object.keys(texts).length > 0 && became !== 'completed';
    const numbers = () => Object.fromEntries(list.map((argument) => [argument.name, numbers_in(text_of(argument), argument.count ?? 1)]));
    typed.value = {subsystem, action: action.name, values: touched ? sent_values : null, numbers: touched ? numbers() : null, refused: became === 'failed'};
  }, [key, JSON.stringify(texts), JSON.stringify(sent_values), became]);
  // With the form, not after a picture: by then another one may stand there.
  useLayoutEffect(() => () => { typed.value = null; }, []);

  const submit = async (event) => {
    event.preventDefault();
    if (wrong || !may_send(action)) return;
    set_problem('');
    // The descriptor wants a second thought of some, and so does a goal that cannot be reached.
    if ((action.confirm || in_its_way) && !asked) {
      set_asked(true);
      setTimeout(() => set_asked(false), confirm_within_ms);
      return;
    }
    set_asked(false);
    try {
      const id = await send(subsystem, action.name, sent_values, Boolean(action.confirm));
      set_sent(id);
      spend(subsystem, action.name, id);
    } catch (error) {
      set_problem(error.message);
    }
  };
  return html`<form class="command" ref=${form} onSubmit=${submit} data-test="command-form" autocomplete="off">
    ${action.description ? html`<p class="about">${action.description}</p>` : null}
    ${jog ? html`<${JogPad} subsystem=${subsystem} action=${action} jog=${jog} />` : null}
    ${list.map((argument, i) => html`<${Field} key=${argument.name} subsystem=${subsystem} action=${action}
      argument=${argument} text=${text_of(argument)} result=${results[i]} focus=${focus && i === 0} now=${now[argument.name]}
      on_text=${(text) => fill_form(subsystem, action.name, {[argument.name]: text})} />`)}
    ${operator.value ? html`<${Words} subsystem=${subsystem} action=${action} texts=${Object.fromEntries(list.map((argument) => [argument.name, text_of(argument)]))} values=${sent_values} />` : null}
    ${recent ? html`<${Recent} subsystem=${subsystem} />` : null}
    <div class=${`foot ${answered ? 'answered' : ''}`}><p class="octets" title="the telecommand packet" data-test="octets">${sent_values ? hex_text(answer?.octets) || '…' : ''}</p>
    ${replay.value ? html`<p class="permission no">replay: telecommands are locked</p>` :
      !operator.value ? html`<p class="permission none">an observer's token: reading only</p>` : sent_values || refused ?
      html`<${Permission} answer=${answer} problem=${answer?.problem} subsystem=${subsystem} action=${action} brief=${recent && answered} />` : html`<p class="permission none">${answer?.permitted ? 'permitted now, once it is filled in' : 'fill in to ask the supervisor'}</p>`}
    ${in_its_way ? html`<p class="permission mind" data-test="goal-in-the-way"><b>Mind the goal:</b> ${in_its_way}. The arm would be stopped on its way.</p>` : null}
    <${Authority} action=${action} />
    ${operator.value ? html`<button class=${`primary ${asked ? 'sure' : refused ? 'refused' : ''}`} type="submit" disabled=${wrong > 0 || !may_send(action)} data-test="send" title=${refused ? `the supervisor would refuse it: ${answer.reason ?? `code ${answer.code}`}` : undefined}>
      ${refused && !asked ? html`<${Lock} />` : null}${mistyped >= 0 ? `${list[mistyped].name}: ${results[mistyped].error}` : wrong ? `${wrong} field${wrong > 1 ? 's' : ''} to fill in` : refused && !asked ? `Send ${action.name} all the same` : asked ? `Really ${action.name}? Once more` : `Send ${action.name}`}</button>` : null}
    ${problem ? html`<p class="permission no">${problem}</p>` : null}
    ${mine ? html`<div class=${`verdict ${outcome_of(mine).stage}`} data-test="verdict">
      <small>${clock_text(mine.t, 3)}</small><${VerdictChain} command=${mine} /></div>` : null}</div>
  </form>`;
}
