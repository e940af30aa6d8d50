// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What a look at a page would find, found by a program: text that is cut or lies on other text, letters of another typeface, words too
// faint to be read. Each finds in what is shown now; `in_page` functions run in the browser.

/// Text whose box is smaller than it, without an ellipsis that says so and a title that has it whole; and text outside of the window or of what clips it.
export function cut_texts() {
  const found = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const text = node.textContent.trim(), parent = node.parentElement;
    if (!text || !parent.checkVisibility({opacityProperty: true, visibilityProperty: true}) || parent.closest('.unseen, option, select, [aria-hidden=true], .readout')) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    const box = range.getBoundingClientRect();
    if (!box.width) continue;
    const say = (why) => found.push(`${why}: “${text.slice(0, 40)}” in ${parent.closest('[aria-label]')?.getAttribute('aria-label') ?? parent.tagName}`);
    let scrolls = false;
    for (let above = parent; above && above !== document.body; above = above.parentElement) {
      const style = getComputedStyle(above);
      if (above instanceof SVGElement && above.tagName !== 'svg') continue;
      if (/(auto|scroll)/.test(style.overflowX + style.overflowY)) scrolls = true;
      if (!/(hidden|clip|auto|scroll)/.test(style.overflowX)) continue;
      const limit = above.getBoundingClientRect();
      if (box.right <= limit.right + 1.5 && box.left >= limit.left - 1.5) continue;
      if (style.textOverflow === 'ellipsis' && (above.title || above.closest('[title]'))) break;
      if (/(auto|scroll)/.test(style.overflowX) && above.scrollWidth > above.clientWidth) break;
      say('cut');
      break;
    }
    if (!scrolls && (box.right > innerWidth + 1 || box.left < -1 || box.bottom > innerHeight + 1)) say('outside');
  }
  return [...new Set(found)];
}

/// Pieces of text of which one lies on another.
export function overlapping_texts() {
  const boxes = [];
  /// What of a box the boxes around it let be seen.
  const shown = (whole, parent) => {
    let {left, top, right, bottom} = whole;
    for (let above = parent; above && above !== document.body; above = above.parentElement) {
      if (!/(hidden|clip|auto|scroll)/.test(getComputedStyle(above).overflowX)) continue;
      const limit = above.getBoundingClientRect();
      [left, top, right, bottom] = [Math.max(left, limit.left), Math.max(top, limit.top), Math.min(right, limit.right), Math.min(bottom, limit.bottom)];
    }
    return {left, top, right, bottom, width: right - left, height: bottom - top};
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const text = node.textContent.trim(), parent = node.parentElement;
    if (!text || !parent.checkVisibility({opacityProperty: true, visibilityProperty: true}) || parent.closest('.unseen, option, .toasts, [aria-hidden=true]')) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const whole of range.getClientRects()) {
      const box = shown(whole, parent);
      if (box.width < 2 || box.height < 2) continue;
      // What is scrolled away, or lies under a menu, is not seen.
      const seen = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
      if (!seen || !(seen === parent || parent.contains(seen) || seen.contains(parent) || getComputedStyle(parent).pointerEvents === 'none' || parent instanceof SVGElement)) continue;
      if (parent instanceof SVGElement || getComputedStyle(parent).pointerEvents === 'none') {
        const clip = parent.closest('.panel')?.getBoundingClientRect();
        if (clip && (box.bottom > clip.bottom || box.top < clip.top)) continue;
      }
      boxes.push({text, box, parent});
    }
  }
  const found = [];
  for (let i = 0; i < boxes.length; ++i) {
    for (let j = i + 1; j < boxes.length; ++j) {
      const a = boxes[i], b = boxes[j];
      // What is opened covers a part of what is behind.
      if (a.parent.closest('[role=dialog]') !== b.parent.closest('[role=dialog]')) continue;
      const wide = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left), tall = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
      if (wide > 2 && tall > 4 && a.parent !== b.parent && !a.parent.contains(b.parent) && !b.parent.contains(a.parent)) found.push(`“${a.text.slice(0, 30)}” on “${b.text.slice(0, 30)}”`);
    }
  }
  return [...new Set(found)];
}

/// Words whose contrast with the colour behind them is below 4.5, where that colour is one of the page (pictures and gradients are judged by eye).
export function faint_texts() {
  const channel = (value) => value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  const brightness = ([r, g, b]) => 0.2126 * channel(r / 255) + 0.7152 * channel(g / 255) + 0.0722 * channel(b / 255);
  const parse = (text) => {
    const numbers = text.match(/[\d.]+/g)?.map(Number) ?? [];
    return text.startsWith('color(') ? [...numbers.slice(0, 3).map((one) => one * 255), numbers[3] ?? 1] : [...numbers.slice(0, 3), numbers[3] ?? 1];
  };
  const over = (top, below) => below.map((value, i) => top[i] * top[3] + value * (1 - top[3]));
  const found = [];
  for (const node of document.querySelectorAll('body *')) {
    const own = [...node.childNodes].some((one) => one.nodeType === Node.TEXT_NODE && one.textContent.trim());
    if (!own || !node.checkVisibility({opacityProperty: true, visibilityProperty: true}) || node.closest('.unseen, .robot, option, .stop_banner, svg, :disabled')) continue;
    const layers = [];
    let picture = false;
    for (let above = node; above; above = above.parentElement) {
      const style = getComputedStyle(above);
      if (style.backgroundImage !== 'none') picture = true;
      layers.push(parse(style.backgroundColor));
      if (layers.at(-1)[3] === 1) break;
    }
    if (picture) continue;
    let below = [255, 255, 255];
    for (const layer of layers.reverse()) below = over(layer, below);
    const text = over(parse(getComputedStyle(node).color), below);
    const [high, low] = [brightness(text), brightness(below)].sort((a, b) => b - a), ratio = (high + 0.05) / (low + 0.05);
    if (ratio < 4.5) found.push(`${ratio.toFixed(1)}: “${node.textContent.trim().slice(0, 30)}” .${node.className}`);
  }
  return [...new Set(found)];
}

/// Words in a colour that calls, where none should: red, orange, amber, but for SAFE ALL, what happened, and the robot.
export function loud_texts() {
  return [...document.querySelectorAll('main *, header *')].filter((node) => !node.closest('.robot, .safe_all, .count, [data-test=events]')).flatMap((node) => {
    const [r, g, b] = getComputedStyle(node).color.match(/[\d.]+/g).map(Number);
    const own = [...node.childNodes].some((one) => one.nodeType === Node.TEXT_NODE && one.textContent.trim());
    return own && r > 200 && Math.max(g, b) < 190 && r - Math.min(g, b) > 70 ? [`${node.className}: ${node.textContent.slice(0, 30)}`] : [];
  });
}

/// The typefaces that the browser really draws what is shown with, and which characters it had to take from others.
export async function typefaces(page) {
  const inspector = await page.context().newCDPSession(page);
  await inspector.send('DOM.enable');
  await inspector.send('CSS.enable');
  const {root} = await inspector.send('DOM.getDocument', {depth: 1});
  const {nodeIds} = await inspector.send('DOM.querySelectorAll', {nodeId: root.nodeId, selector: 'body, svg text'});
  const found = new Map();
  for (const nodeId of nodeIds) {
    const {fonts} = await inspector.send('CSS.getPlatformFontsForNode', {nodeId}).catch(() => ({fonts: []}));
    for (const {familyName, glyphCount, isCustomFont} of fonts) found.set(familyName, {letters: (found.get(familyName)?.letters ?? 0) + glyphCount, own: isCustomFont});
  }
  await inspector.detach();
  return found;
}
