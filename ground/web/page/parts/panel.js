// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useEffect, useState} from 'preact/hooks';
import {html} from '../html.js';

/// A titled box; `bare` ones fill it themselves and do not scroll. Each can fill the window; Escape brings it back.
export function Panel({title, hint, area, href, bare, titleless, tools, children}) {
  const [large, set_large] = useState(false);
  useEffect(() => {
    if (!large) return;
    const back = (event) => { if (event.key === 'Escape') set_large(false); };
    addEventListener('keydown', back);
    return () => removeEventListener('keydown', back);
  }, [large]);
  return html`<section class=${`panel ${bare ? 'bare' : ''} ${titleless ? 'titleless' : ''} ${large ? 'large' : ''}`} style=${area ? {gridArea: area} : undefined} aria-label=${title}>
    <h2>${titleless ? null : href ? html`<a href=${href}>${title}</a>` : title}${hint ? html`<small title=${hint}>${hint}</small>` : null}
      <span class="space" /><button class="enlarge" aria-label=${`${title}: ${large ? 'back to its place' : 'fill the window'}`} aria-pressed=${large}
        onClick=${() => set_large(!large)}><svg viewBox="0 0 12 12" aria-hidden="true"><path d=${large ? 'M5 1v4H1M7 11V7h4' : 'M7 1h4v4M5 11H1V7'} /></svg></button>${tools}</h2>
    <div class="body" tabindex=${bare ? undefined : 0} role=${bare ? undefined : 'group'} aria-label=${bare ? undefined : title}>${children}</div>
  </section>`;
}
