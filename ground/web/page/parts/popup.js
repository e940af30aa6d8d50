// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import {useEffect, useRef} from 'preact/hooks';

/// The node of what is open; a click beside it, or Escape, closes it.
export function usePopup(open, set_open) {
  const node = useRef(null);
  useEffect(() => {
    if (!open) return;
    const close = (event) => {
      if (event.type === 'keydown' ? event.key === 'Escape' : !node.current?.contains(event.target)) set_open(false);
    };
    addEventListener('pointerdown', close);
    addEventListener('keydown', close);
    return () => { removeEventListener('pointerdown', close); removeEventListener('keydown', close); };
  }, [open]);
  return node;
}
