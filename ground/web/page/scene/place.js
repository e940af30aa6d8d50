// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Where something stands that moves with every picture. A browser that is told a new transform by style makes a new list of all its layers (2 ms of
// a page like this, measured); one that is told how far an animation has come moves one layer. So these animations never run: they are rulers.

/// One px a millisecond, and a power of two of them: whole px stay whole.
const ruler_px = 8192;
const along = (x, y) => [{transform: 'translate(0px, 0px)'}, {transform: `translate(${x}px, ${y}px)`}];

/// Puts `node`, which stands at the upper left of its parent, to [x, y] in px from there, 0 to 8192 each. Where it stands already, nothing is said.
export function placing(node) {
  const [x, y] = [along(ruler_px, 0), along(0, ruler_px)].map((frames, i) => {
    const ruler = node.animate(frames, {duration: ruler_px, fill: 'both', composite: i ? 'add' : 'replace'});
    ruler.pause();
    return ruler;
  });
  return (x_px, y_px) => {
    if (x.currentTime !== x_px) x.currentTime = x_px;
    if (y.currentTime !== y_px) y.currentTime = y_px;
  };
}
