// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useEffect, useState} from 'preact/hooks';
import {copy} from '../commanding.js';
import {html} from '../html.js';
import {command_is, commander} from '../people.js';
import {operator, replay} from '../store.js';
import {arguments_text} from './arguments.js';
import {Panel} from './panel.js';
import {action_of, ask_for_stacks, empty, forget, halt, is_kept, keep, move_row, open, rename, run, running, stack, stacks, take_out, take_text, text_now, values_of} from './stack.js';

const words_of = (outcome) => !outcome ? '' : outcome.stage === 'failed' ? `failed: ${outcome.reason ?? ''}${outcome.code ? ` (code ${outcome.code})` : ''}` : outcome.stage;
const confirm_within_ms = 6000;

function Row({row, i, last, locked}) {
  const {values, problem} = values_of(row), busy = running.value, at = busy?.at === i;
  return html`<li class=${`${row.outcome?.stage ?? ''} ${at ? 'at' : ''}`} data-test="stack-row">
    <div class="row"><b>${i + 1}. ${row.subsystem} ${row.function}</b>
      <button type="button" class="tiny" disabled=${locked || Boolean(busy)} aria-label=${`send row ${i + 1} alone`} title="this one alone" onClick=${() => run(i, false)}>▸</button>
      <button type="button" class="tiny" disabled=${Boolean(busy) || i === 0} aria-label=${`row ${i + 1} up`} onClick=${() => move_row(i, -1)}>↑</button>
      <button type="button" class="tiny" disabled=${Boolean(busy) || last} aria-label=${`row ${i + 1} down`} onClick=${() => move_row(i, 1)}>↓</button>
      <button type="button" class="tiny" disabled=${Boolean(busy)} aria-label=${`row ${i + 1} out of the stack`} onClick=${() => take_out(i)}>×</button></div>
    ${values && Object.keys(values).length ? html`<div class="words">${arguments_text({...row, arguments: values})}</div>` : null}
    ${problem ? html`<div class="verdict failed">${problem}</div>` : row.outcome ? html`<div class=${`verdict ${row.outcome.stage}`} data-test="stack-verdict">${words_of(row.outcome)}</div>` : null}</li>`;
}

/// The same as lines of `hirosco tc`, to be taken elsewhere or pasted here.
function AsText({on_done}) {
  const [text, set_text] = useState(text_now()), [problem, set_problem] = useState('');
  const take = () => {
    const wrong = take_text(text);
    set_problem(wrong);
    if (!wrong) on_done();
  };
  return html`<textarea class="script" data-test="stack-text" rows="8" spellcheck="false" aria-label="the stack as lines of hirosco tc" value=${text} onInput=${(event) => set_text(event.currentTarget.value)} />
    ${problem ? html`<p class="permission no" data-test="stack-problem">${problem}</p>` : null}
    <p class="words_of"><button type="button" class="link" data-test="stack-take" onClick=${take}>take these lines</button>
      <button type="button" class="link" onClick=${() => copy(text, 'copied for the terminal')}>copy</button><button type="button" class="link" onClick=${on_done}>back</button></p>`;
}

function Kept() {
  const list = stacks(), {name, rows} = stack.value, may = operator.value && !replay.value;
  useEffect(ask_for_stacks, []);
  return html`<div class="row kept"><input aria-label="name of the stack" data-test="stack-name" maxlength="40" placeholder="name" value=${name} onInput=${(event) => rename(event.currentTarget.value)} />
    <button type="button" class="chip" data-test="stack-keep" disabled=${!may || !name.trim() || !rows.length || is_kept()} title="for everybody at this station" onClick=${keep}>${is_kept() ? 'kept' : 'keep'}</button>
    ${list.length ? html`<select aria-label="stacks that are kept" data-test="stack-open" value="" onChange=${(event) => open(event.currentTarget.value)}>
      <option value="">open …</option>${list.map((one) => html`<option value=${one.name} title=${`kept by ${one.who}`}>${one.name}</option>`)}</select>` : null}
    ${may && list.some((one) => one.name === name) ? html`<button type="button" class="chip" data-test="stack-forget" onClick=${() => forget(name)}>forget</button>` : null}</div>`;
}

export function StackPanel() {
  const [text, set_text] = useState(false), [asked, set_asked] = useState(false);
  const {rows} = stack.value, busy = running.value;
  const locked = !operator.value || Boolean(replay.value) || command_is.value === 'other';
  // Where the last run ended it goes on; what failed is sent again.
  const done = rows.findIndex((row) => row.outcome?.stage !== 'completed'), from = done < 0 ? 0 : done;
  const second_thought = rows.slice(from).some((row) => action_of(row)?.confirm);
  const start = () => {
    if (second_thought && !asked) {
      set_asked(true);
      setTimeout(() => set_asked(false), confirm_within_ms);
      return;
    }
    set_asked(false);
    run(from);
  };
  const title = busy ? 'Stop after this one' : asked ? 'Really? Once more' : from > 0 ? `Go on from row ${from + 1}` : `Send all ${rows.length}`;
  return html`<${Panel} title="Stack" hint=${rows.length ? `${rows.length} row${rows.length > 1 ? 's' : ''}` : ''} area="stack"
    tools=${html`<button type="button" class=${`chip ${text ? 'on' : ''}`} aria-pressed=${text} data-test="stack-as-text" onClick=${() => set_text(!text)}>as text</button>`}>
    ${text ? html`<${AsText} on_done=${() => set_text(false)} />` : html`
      ${rows.length ? html`<ol class="stack" data-test="stack">${rows.map((row, i) => html`<${Row} key=${i} row=${row} i=${i} last=${i === rows.length - 1} locked=${locked} />`)}</ol>` :
        html`<p class="empty">"to the stack" in a form adds a row; "as text" takes lines of hirosco tc.</p>`}
      <${Kept} />
      ${rows.length && operator.value ? html`<div class="row"><button type="button" class=${`primary ${asked ? 'sure' : ''}`} data-test="stack-run" disabled=${locked && !busy} onClick=${busy ? halt : start}>${title}</button>
        <button type="button" class="chip" disabled=${Boolean(busy)} data-test="stack-empty" onClick=${empty}>empty</button></div>` : null}
      ${rows.length && command_is.value === 'other' ? html`<p class="permission no"><b>${commander.value} commands.</b></p>` : null}`}
  </${Panel}>`;
}
