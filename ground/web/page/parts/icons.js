// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {html} from '../html.js';

const paths = {
  overview: 'M3 3h8v8H3zM13 3h8v5h-8zM13 10h8v11h-8zM3 13h8v8H3z',
  subsystems: 'M12 2l9 5v10l-9 5-9-5V7zM12 12l9-5M12 12v10M12 12L3 7',
  plots: 'M3 3v18h18M6 16l4-6 4 3 6-8',
  commands: 'M4 5l6 7-6 7M12 19h8',
  links: 'M5 8a3 3 0 1 0 0-.01M19 18a3 3 0 1 0 0-.01M7 10l9 6M19 6a2 2 0 1 0 0-.01M8 7l9-1',
  events: 'M12 3l10 18H2zM12 10v5M12 18v.5',
  timeline: 'M2 7h7M12 7h10M2 12h14M19 12h3M2 17h4M9 17h9',
  faults: 'M13 2L5 14h6l-1 8 8-12h-6z',
  theme: 'M12 3a9 9 0 1 0 .01 0M12 3v18M12 7a5 5 0 0 1 0 10',
  help: 'M9 9a3 3 0 1 1 4 3c-1 .5-1 1-1 2.5M12 18v.5M12 2a10 10 0 1 0 .01 0',
};

export const Icon = ({name}) => html`
  <svg class="icon" viewBox="0 0 24 24" aria-hidden="true"><path d=${paths[name]} /></svg>`;

const shapes = {
  high: 'M4 .7h8L15.6 8 12 15.3H4L.4 8z',
  medium: 'M8 1.5L15 14.5H1z',
  low: 'M2.5 2.5h11v11h-11z',
  info: 'M8 4.5a3.5 3.5 0 1 0 .01 0',
};

/// Severity by shape and by word, never by colour alone.
export const Severity = ({severity, word = false}) => html`
  <span class=${`severity ${severity}`} title=${severity}>
    <svg viewBox="0 0 16 16" aria-hidden="true"><path d=${shapes[severity] ?? shapes.info} /></svg>${word ? severity :
      html`<span class="unseen">${severity}</span>`}
  </span>`;
