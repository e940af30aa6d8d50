// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Every field of every telecommand form against the mission's own ranges: what the form and what the gateway take.
const whole = {UINT8: [0, 255], UINT16: [0, 65535], UINT32: [0, 2 ** 32 - 1], INT8: [-128, 127], INT16: [-32768, 32767], INT32: [-(2 ** 31), 2 ** 31 - 1],
  UINT64: [0, 2 ** 53 - 1], INT64: [-(2 ** 53 - 1), 2 ** 53 - 1]};
const never = ['NaN', 'Infinity', '-Infinity', 'left', '', '0x1', Array.from({length: 17}, (_, i) => i + 1).join(' ')];  // no array is as long

function cases_of(argument) {
  if (argument.type === 'TEXT') return {good: ['x'.repeat(argument.octets), 'left', '\u20ac'], bad: ['x'.repeat(argument.octets + 1), `${'\u20ac'.repeat(Math.ceil(argument.octets / 3))}xx`]};
  const [low, high] = whole[argument.type] ?? [-Infinity, Infinity];
  const least = Math.max(low, argument.min ?? -Infinity), most = Math.min(high, argument.max ?? Infinity);
  const finite = [least, most].filter(Number.isFinite);
  const good = finite.length ? finite : [0, 1, -1.5];
  const bad = [least - 1, most + 1].filter((value) => Number.isFinite(value) && Number.isSafeInteger(Math.round(value)));
  const repeated = (text) => new Array(argument.count ?? 1).fill(text).join(' ');
  return {good: good.map((value) => repeated(String(value))), bad: [...bad.map((value) => repeated(String(value))), ...never]};
}

/// `mission` without what `seen`, a set of texts that grows, has already: missions share subsystems, and the same form judges the same.
export function unseen_of(mission, seen) {
  const is_new = (subsystem, action) => {
    const text = JSON.stringify([subsystem.name, action]);
    return !seen.has(text) && seen.add(text);
  };
  return {...mission, subsystems: mission.subsystems.map((one) => ({...one, functions: one.functions.filter((action) => is_new(one, action))}))};
}

/// In the page: opens the form at an address and fills its fields with texts, one after the other. For each: how many choices it has, or which
/// texts it takes.
async function fill_fields({address, fields}) {
  const turn = () => new Promise((resolve) => setTimeout(resolve));
  if (location.hash !== address) {
    const there = new Promise((resolve) => addEventListener('hashchange', resolve, {once: true}));
    location.hash = address;
    await there;
  }
  const answers = [];
  for (const {name, texts} of fields) {
    // What is drawn anew is so after the page's own turn.
    let node = null;
    do {
      await turn();
      await turn();
      node = document.querySelector(`[data-test="field-${name}"]`);
    } while (!node);
    if (node.tagName === 'SELECT') {
      answers.push({choices: node.querySelectorAll('option').length});
      continue;
    }
    const taken = [], set = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set;
    for (const text of texts) {
      set.call(node, text);
      node.dispatchEvent(new InputEvent('input', {bubbles: true}));
      await turn();
      await turn();
      taken.push(node.isConnected && node.value !== '' && node.getAttribute('aria-invalid') !== 'true');
    }
    answers.push({taken});
  }
  return answers;
}

/// Fills every field of every form of `mission` in `page`: {fields, choices, cases, wrong: [what was judged amiss]}.
export async function judge_forms(page, mission) {
  const found = {fields: 0, choices: 0, cases: 0, wrong: []};
  for (const subsystem of mission.subsystems) {
    for (const action of subsystem.functions) {
      if (!action.arguments.length) continue;
      const fields = action.arguments.map((argument) => {
        const {good, bad} = cases_of(argument);
        return {name: argument.name, texts: [...bad, ...good], good: bad.length};
      });
      // As fast as the page follows, not as a hand types: there are thousands.
      const answers = await page.evaluate(fill_fields, {address: `#/commands/${subsystem.name}/${action.name}`, fields});
      answers.forEach(({choices, taken}, i) => {
        const {name, texts, good} = fields[i], where = `${subsystem.name} ${action.name} ${name}`;
        ++found.fields;
        if (!taken) {
          ++found.choices;
          if (choices === 0) found.wrong.push(`${where}: nothing to choose`);
          return;
        }
        found.cases += texts.length;
        texts.forEach((text, k) => { if (taken[k] !== (k >= good)) found.wrong.push(`${where}: ${k >= good ? 'rejects' : 'takes'} "${text}"`); });
      });
    }
  }
  return found;
}

/// The same values to the gateway, which must agree: {cases, wrong}.
export async function judge_gateway(mission, ask) {
  const found = {cases: 0, wrong: []};
  for (const subsystem of mission.subsystems) {
    for (const action of subsystem.functions) {
      const value_of = (argument, text) => {
        const one = (word) => argument.type !== 'TEXT' && Number.isFinite(Number(word)) && word !== '' ? Number(word) : word;
        return (argument.count ?? 1) > 1 ? text.split(' ').map(one) : one(text);
      };
      const fine = Object.fromEntries(action.arguments.map((argument) =>
        [argument.name, argument.enumeration?.length ? argument.enumeration[0].value : value_of(argument, cases_of(argument).good[0])]));
      for (const argument of action.arguments) {
        const {good, bad} = cases_of(argument);
        const tries = argument.enumeration?.length ? argument.enumeration.map(({value}) => [value, true]) :
          [...good.map((text) => [value_of(argument, text), true]), ...bad.filter((text) => text !== '0x1').map((text) => [value_of(argument, text), false])];
        for (const [value, wanted] of tries) {
          ++found.cases;
          const status = await ask({subsystem: subsystem.name, function: action.name, arguments: {...fine, [argument.name]: value}});
          if ((status === 200) !== wanted) found.wrong.push(`gateway: ${subsystem.name} ${action.name} ${argument.name} ${JSON.stringify(value)}: ${status}`);
        }
      }
    }
  }
  return found;
}
