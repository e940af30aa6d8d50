// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The scene alone as a picture: what stands still, what moves, and below it of which mission and when. No buttons, no tags, no picture of the hand.

const line_px = 22, side_px = 10;

/// A canvas with the scene of `view` as it is drawn now; `words` below it.
export function snapshot_of(view, words) {
  const {x: width, y: height} = view.size, own = view.live ? null : view.renderer?.domElement;
  const {inset} = view;
  const ratio = own ? own.width / width : 1, canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [width * ratio, (height + line_px) * ratio];
  const context = canvas.getContext('2d');
  context.scale(ratio, ratio);
  context.fillStyle = '#04060a';
  context.fillRect(0, 0, width, height + line_px);
  // A graphics card forgets what it has shown: it is drawn anew, without the hand, and taken before the browser goes on.
  view.inset = null;
  view.draw_live();
  if (own) {
    context.drawImage(own, 0, 0, width, height);
  } else {
    if (view.nodes.still.width) context.drawImage(view.nodes.still, 0, 0, width, height);
    view.live.copy_to(context);
  }
  view.inset = inset;
  view.draw_live();
  context.fillStyle = '#b0b8c2';
  context.font = '12px Inter, sans-serif';
  context.fillText(words, side_px, height + 15);
  return canvas;
}
