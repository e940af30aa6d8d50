// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Expressions of parameters, as `ARM.FORCE[0] * 2 - abs(HAND.TORQUE[1])`: read by a parser of our own, so that
// an address that somebody sends can reckon and do nothing else. Everything is bounded. Without browser and archive: who calls brings the samples.

export const longest_text = 300;
const most_nodes = 120, deepest = 24, most_inputs = 8;

const functions = {abs: [1, Math.abs], sqrt: [1, Math.sqrt], sin: [1, Math.sin], cos: [1, Math.cos], tan: [1, Math.tan], asin: [1, Math.asin], acos: [1, Math.acos],
  atan: [1, Math.atan], exp: [1, Math.exp], log: [1, Math.log], sign: [1, Math.sign], deg: [1, (rad) => rad * 180 / Math.PI], atan2: [2, Math.atan2],
  min: [2, Math.min, true], max: [2, Math.max, true], hypot: [2, Math.hypot, true]};
const constants = {pi: Math.PI};
/// Who has its argument's unit.
const unit_kept = new Set(['abs', 'min', 'max', 'hypot']);
export const function_names = Object.keys(functions);

/// `at`: the place of what is wrong in the text, from 0.
export class ExpressionError extends Error {
  constructor(message, at) {
    super(`${message}, at character ${at + 1}`);
    this.at = at;
  }
}

const token_pattern = /\s*(?:(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|([A-Za-z_][\w.]*(?:\[\d+\])*(?:@\d+)?)|([-+*/^(),]))/y;

function tokens_of(text) {
  const found = [];
  for (let at = 0; at < text.length;) {
    if (!text.slice(at).trim()) break;
    token_pattern.lastIndex = at;
    const match = token_pattern.exec(text);
    const begin = at + /^\s*/.exec(text.slice(at))[0].length;
    if (!match) throw new ExpressionError(`“${text[begin]}” is neither a number, a parameter nor one of + − * / ^ ( ) ,`, begin);
    const [, number, name, sign] = match;
    found.push({at: begin, number, name, sign, text: number ?? name ?? sign});
    at = token_pattern.lastIndex;
  }
  return found;
}

/// How many letters two names do not share, as far as that matters for a guess.
function distance(a, b) {
  let before = Array.from({length: b.length + 1}, (_, i) => i);
  for (let i = 1; i <= a.length; ++i) {
    const row = [i];
    for (let j = 1; j <= b.length; ++j) row.push(Math.min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] === b[j - 1] ? 0 : 1)));
    before = row;
  }
  return before[b.length];
}

/// The nearest of `names`, if it is near enough to be what was meant.
export function nearest(wrong, names) {
  const upper = wrong.toUpperCase();
  let best = null, least = Math.max(2, wrong.length / 3);
  for (const name of names) {
    const far = name.toUpperCase().endsWith(`.${upper}`) ? 0.5 : distance(upper, name.toUpperCase());
    if (far <= least && (best === null || far < least)) [best, least] = [name, far];
  }
  return best;
}

const same_unit = (a, b) => a === b ? a : a === '' || b === '' ? a || b : null;

/// What `text` says: {inputs: [parameter names], unit, at(values)}; without a unit where units that differ are added or multiplied. `known(name)`
/// answers {unit, words} of a parameter, `words` when its values are no numbers, and undefined where there is none; `names` are those that a
/// guess may be of. Throws ExpressionError.
export function parse(text, known, names = []) {
  if (text.length > longest_text) throw new ExpressionError(`an expression has at most ${longest_text} characters`, longest_text);
  const tokens = tokens_of(text), inputs = [];
  let next = 0, nodes = 0;
  const peek = () => tokens[next];
  const here = () => peek()?.at ?? text.length;
  const made = (node) => {
    if (++nodes > most_nodes) throw new ExpressionError(`more than ${most_nodes} numbers, parameters and signs`, here());
    return node;
  };
  const takes = (...signs) => signs.includes(peek()?.sign) ? tokens[next++] : null;
  const expect = (sign, what) => {
    if (!takes(sign)) throw new ExpressionError(peek() ? `${what} expected and not “${peek().text}”` : `${what} is missing`, here());
  };

  function parameter({name, at}) {
    const column = known(name);
    if (!column) {
      const guess = nearest(name, names);
      throw new ExpressionError(`no parameter “${name}”${guess ? `, did you mean ${guess}?` : ''}`, at);
    }
    if (column.words) throw new ExpressionError(`${name} has words for values, no numbers`, at);
    if (!inputs.includes(name)) inputs.push(name);
    if (inputs.length > most_inputs) throw new ExpressionError(`more than ${most_inputs} parameters`, at);
    const place = inputs.indexOf(name);
    return made({unit: column.unit ?? '', of: (values) => values[place]});
  }

  function called({name, at}, depth) {
    const [least, reckon, more] = functions[name], given = [];
    expect('(', `“(” after ${name}`);
    do given.push(sum(depth + 1)); while (takes(','));
    expect(')', `“)” after what ${name} is of`);
    if (given.length < least || (given.length > least && !more)) throw new ExpressionError(`${name} is of ${least} ${least === 1 ? 'value' : 'values'}${more ? ' or more' : ''}, not of ${given.length}`, at);
    const unit = name === 'deg' ? 'deg' : unit_kept.has(name) ? given.map((one) => one.unit).reduce((a, b) => a === null || b === null ? null : same_unit(a, b)) : '';
    return made({unit, of: (values) => reckon(...given.map((one) => one.of(values)))});
  }

  function primary(depth) {
    if (depth > deepest) throw new ExpressionError(`nested deeper than ${deepest}`, here());
    const token = tokens[next++];
    if (!token) throw new ExpressionError('it ends where a number or a parameter should be', text.length);
    if (token.number !== undefined) {
      const value = Number(token.number);
      return made({unit: '', constant: value, of: () => value});
    }
    if (token.name !== undefined) {
      if (peek()?.sign === '(' && !Object.hasOwn(functions, token.name)) {
        const guess = nearest(token.name, function_names);
        throw new ExpressionError(`no function “${token.name}”${guess ? `, did you mean ${guess}?` : `; there are ${function_names.join(', ')}`}`, token.at);
      }
      if (Object.hasOwn(functions, token.name)) return called(token, depth);
      if (Object.hasOwn(constants, token.name)) return made({unit: '', constant: constants[token.name], of: () => constants[token.name]});
      return parameter(token);
    }
    if (token.sign !== '(') throw new ExpressionError(`a number or a parameter expected and not “${token.text}”`, token.at);
    const inner = sum(depth + 1);
    expect(')', '“)”');
    return inner;
  }

  function power(depth) {
    const base = primary(depth);
    if (!takes('^')) return base;
    const exponent = signed(depth + 1);
    return made({unit: base.unit === '' ? '' : null, of: (values) => base.of(values) ** exponent.of(values)});
  }

  function signed(depth) {
    if (depth > deepest) throw new ExpressionError(`nested deeper than ${deepest}`, here());
    if (takes('+')) return signed(depth + 1);
    if (!takes('-')) return power(depth);
    const inner = signed(depth + 1);
    return made({unit: inner.unit, of: (values) => -inner.of(values)});
  }

  function product(depth) {
    let left = signed(depth);
    for (let sign = takes('*', '/'); sign; sign = takes('*', '/')) {
      const one = left, other = signed(depth), times = sign.sign === '*';
      const unit = times ? (one.unit === '' ? other.unit : other.unit === '' ? one.unit : null) : other.unit === '' ? one.unit : one.unit !== null && one.unit === other.unit ? '' : null;
      left = made({unit, of: times ? (values) => one.of(values) * other.of(values) : (values) => one.of(values) / other.of(values)});
    }
    return left;
  }

  function sum(depth) {
    let left = product(depth);
    for (let sign = takes('+', '-'); sign; sign = takes('+', '-')) {
      const one = left, other = product(depth);
      const unit = one.unit === null || other.unit === null ? null : same_unit(one.unit, other.unit);
      left = made({unit, of: sign.sign === '+' ? (values) => one.of(values) + other.of(values) : (values) => one.of(values) - other.of(values)});
    }
    return left;
  }

  if (!tokens.length) throw new ExpressionError('nothing is written yet', 0);
  const whole = sum(0);
  if (next < tokens.length) throw new ExpressionError(`“${peek().text}” follows where the expression should end`, here());
  if (!inputs.length) throw new ExpressionError('no parameter is in it', 0);
  return {inputs, unit: whole.unit ?? '', at: whole.of};
}

/// The expression at each time at which one of its inputs has a sample: [{t, v}], `v` null in gaps. The others are held from their newest sample on, for `held_s`
/// at most; what is no number is a gap.
export function reckon({inputs, at}, samples, held_s) {
  const t = [], v = [], places = inputs.map(() => -1), values = inputs.map(() => NaN);
  for (;;) {
    let now = Infinity;
    samples.forEach((one, i) => { now = Math.min(now, one.t[places[i] + 1] ?? Infinity); });
    if (now === Infinity) return {t, v};
    let whole = true;
    samples.forEach((one, i) => {
      while (places[i] + 1 < one.t.length && one.t[places[i] + 1] <= now) ++places[i];
      const value = places[i] < 0 ? null : one.v[places[i]];
      if (value === null || value === undefined || now - one.t[places[i]] > held_s[i]) whole = false;
      values[i] = Number(value);
    });
    const result = whole ? at(values) : NaN;
    t.push(now);
    v.push(Number.isFinite(result) ? result : null);
  }
}
