// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {html} from '../html.js';

/// A titled box; `bare` ones fill it themselves and do not scroll.
export const Panel = ({title, hint, area, href, bare, tools, children}) => html`
  <section class=${`panel ${bare ? 'bare' : ''}`} style=${area ? {gridArea: area} : undefined} aria-label=${title}>
    <h2>${href ? html`<a href=${href}>${title}</a>` : title}${hint ? html`<small>${hint}</small>` : null}
      ${tools ? html`<span class="space" />${tools}` : null}</h2>
    <div class="body" tabindex=${bare ? undefined : 0} role=${bare ? undefined : 'group'} aria-label=${bare ? undefined : title}>${children}</div>
  </section>`;
