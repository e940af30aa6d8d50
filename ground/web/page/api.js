// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Requests to the gateway. The token stands in the fragment of the printed URL, which a browser never sends anywhere; it is
// kept for the tab and taken out of the address line.

const stored = 'hirosco-token';

export function take_token() {
  const match = /[#&?]token=([^&]+)/.exec(location.hash);
  if (match) {
    try {
      sessionStorage.setItem(stored, decodeURIComponent(match[1]));
    } catch (error) {
      if (!(error instanceof URIError)) throw error;  // no token of ours: asked for as if there were none
    }
    // What else stands there stays: a view, a moment.
    const rest = location.hash.replace(/token=[^&]+&?/, '').replace(/[?&]$/, '');
    const at = /[#&?](at=[\d.]+)/.exec(rest)?.[1];
    history.replaceState(null, '', rest.startsWith('#/') ? rest : `#/overview${at ? `?${at}` : ''}`);
  }
  return token();
}

export const token = () => sessionStorage.getItem(stored) ?? '';

/// Who this page is to the station when it asks who commands: the same after a reload, another one in another tab.
const seat_stored = 'hirosco-seat';
export const seat = sessionStorage.getItem(seat_stored) ?? crypto.randomUUID();
sessionStorage.setItem(seat_stored, seat);

export class RequestError extends Error {
  constructor(status, message) {
    super(message);
    this.status = status;
  }
}

let client = '';
/// The name that the gateway gave our WebSocket: it knows by it that a replaying page must not command.
export const introduce = (name) => { client = String(name ?? ''); };

async function request(path, options = {}) {
  const own = client ? {'X-Client': client} : {};
  const response = await fetch(path, {...options, headers: {...options.headers, ...own, Authorization: `Bearer ${token()}`}})
      .catch(() => { throw new RequestError(0, 'the gateway does not answer'); });
  const text = await response.text();
  let answer;
  try {
    answer = text ? JSON.parse(text) : {};
  } catch {
    answer = {};
  }
  if (!response.ok) {
    throw new RequestError(response.status, answer.error ?? (text.slice(0, 300) || `HTTP ${response.status}`));
  }
  return answer;
}

const query = (parameters) => new URLSearchParams(
    Object.entries(parameters).filter(([, value]) => value !== undefined && value !== null && value !== '')).toString();

export const get = (path, parameters = {}) => {
  const words = query(parameters);
  return request(words ? `${path}?${words}` : path);
};

export const post = (path, body) =>
  request(path, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});

/// A file of the page itself, not of the API.
export async function asset(path) {
  const response = await fetch(path);
  if (!response.ok) throw new RequestError(response.status, `${path}: HTTP ${response.status}`);
  return response;
}

/// What SET_MODE would do now: {steps: [words], stages, reasons: [words]}, as the supervisor says; steps of one stage go on at once.
export async function mode_preview(mode) {
  const {steps, against} = await post('/api/modes/preview', {mode});
  return {stages: Math.max(0, ...steps.map((one) => one.stage)), steps: steps.map((one) => `${one.subsystem} ${one.what}`), reasons: against};
}
