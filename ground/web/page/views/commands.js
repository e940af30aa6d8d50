// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {clock_text, state_text} from '../format.js';
import {name_operator, operator_name} from '../commanding.js';
import {html} from '../html.js';
import {arguments_text} from '../parts/arguments.js';
import {again, CommandForm, edit, VerdictChain} from '../parts/command_form.js';
import {favourite_text, favourites, toggle_favourite} from '../parts/favourites.js';
import {Panel} from '../parts/panel.js';
import {Splits} from '../parts/splits.js';
import {StackPanel} from '../parts/stack_panel.js';
import {fill_form} from '../parts/typed.js';
import {commands, mission, mode_of, operator, outcome_of, replay} from '../store.js';

/// Whether the mode's list permits it at all; the supervisor's own answer stands in the form.
export function listed(subsystem, action) {
  const permits = mode_of.value.permits;
  if (action.essential || !Array.isArray(permits)) return true;
  return permits.some((permit) => [subsystem, '*'].includes(permit.subsystem) &&
    ((permit.functions ?? []).includes(action.name) || (permit.services ?? []).includes(action.service)));
}

/// What a visitor sees first: something of the mission's own, and nothing that takes a subsystem down.
const harmless = (found) => found.find(({subsystem, action}) => subsystem.id >= 10 && (action.service >= 192 || !['SET_STATE', 'CONFIGURE'].includes(action.name))) ?? found.at(-1);

export function Commands({rest}) {
  const [search, set_search] = useState('');
  const list = mission.value?.subsystems ?? [];
  const words = search.toLowerCase();
  const found = list.flatMap((subsystem) => (subsystem.functions ?? [])
      .filter((action) => `${subsystem.name} ${action.name} ${action.description}`.toLowerCase().includes(words))
      .map((action) => ({subsystem, action})));
  const chosen = found.find(({subsystem, action}) => subsystem.name === rest[0] && action.name === rest[1]) ??
    list.flatMap((subsystem) => (subsystem.functions ?? []).map((action) => ({subsystem, action})))
        .find(({subsystem, action}) => subsystem.name === rest[0] && action.name === rest[1]) ?? (words ? found[0] : harmless(found));
  return html`<main class="commands"><${Splits} name="commands" rows=${false} />
    <${Panel} title="Telecommands">
      <input class="search" type="search" placeholder="search  /" aria-label="search telecommands" value=${search} data-search
        onInput=${(event) => set_search(event.currentTarget.value)}
        onKeyDown=${(event) => { if (event.key === 'Enter' && found[0]) location.hash = `#/commands/${found[0].subsystem.name}/${found[0].action.name}`; }} />
      <${Favourites} />
      ${list.map((subsystem) => {
        const own = found.filter((one) => one.subsystem === subsystem);
        return own.length ? html`<div class="group" key=${subsystem.name}><h3>${subsystem.name}</h3>${own.map(({action}) => html`
          <a class=${`action ${chosen?.action === action ? 'chosen' : ''} ${listed(subsystem.name, action) ? '' : 'locked'}`}
            href=${`#/commands/${subsystem.name}/${action.name}`} title=${listed(subsystem.name, action) ? action.description : `not permitted in mode ${mode_of.value.name}`}>
            ${action.name}${action.essential ? html`<small>essential</small>` : listed(subsystem.name, action) ? null : html`<small>not in this mode</small>`}</a>`)}</div>` : null;
      })}
    </${Panel}>
    <${Panel} title=${chosen ? `${chosen.subsystem.name} ${chosen.action.name}` : 'Telecommand'}
      hint=${chosen ? `TC[${chosen.action.service ?? 8},${chosen.action.subtype ?? 1}] to APID ${chosen.subsystem.id}` : ''}>
      ${chosen ? html`<${CommandForm} key=${`${chosen.subsystem.name}.${chosen.action.name}`} subsystem=${chosen.subsystem.name} action=${chosen.action} focus />
        ${chosen.action.states?.length ? html`<p class="about">Taken in ${chosen.action.states.map(state_text).join(', ')}.</p>` : null}` : html`<p class="empty">Nothing found.</p>`}
    </${Panel}>
    <div class="column"><${StackPanel} />
    <${Panel} title="History" hint="of all operators" tools=${html`<label class="sender_name">you are <input aria-label="your name" maxlength="32"
      placeholder="operator" value=${operator_name.value} onInput=${(event) => name_operator(event.currentTarget.value)} /></label>`}><${History} /></${Panel}></div>
  </main>`;
}

/// Kept by this browser: a click fills the form.
function Favourites() {
  const list = favourites();
  if (!list.length) return null;
  return html`<div class="group" data-test="favourites"><h3>Kept at hand</h3>${list.map((one) => html`<div class="row"><a class="action" href=${`#/commands/${one.subsystem}/${one.function}`}
    onClick=${() => fill_form(one.subsystem, one.function, one.texts)}><span>${favourite_text(one)}</span><small>${one.subsystem}</small></a>
    <button class="tiny" aria-label=${`no longer keep ${favourite_text(one)}`} onClick=${() => toggle_favourite(one)}>×</button></div>`)}</div>`;
}

function History() {
  const list = commands.value.slice(0, 150);
  return html`<ol class="history" data-test="history">${list.map((command) => {
    const outcome = outcome_of(command);
    return html`<li key=${command.id} class=${outcome.stage}>
      <div class="row"><span class="time">${clock_text(command.t, 1)}</span><b>${command.subsystem} ${command.function}</b>
        ${operator.value && !replay.value && command.function !== '?' ? html`<button class="again" onClick=${() => again(command)}>again</button><button class="again" onClick=${() => edit(command)}>edit</button>` : null}
        <small class="sender">${command.sender ?? ''}${command.mine ? ' (this page)' : ''}</small></div>
      ${arguments_text(command) ? html`<div class="words">${arguments_text(command)}</div>` : null}
      <${VerdictChain} command=${command} /></li>`;
  })}</ol>${list.length ? null : html`<p class="empty">No telecommand has been sent.</p>`}
    ${commands.value.length > list.length ? html`<p class="about">The newest ${list.length}; all are in the log.</p>` : null}`;
}
