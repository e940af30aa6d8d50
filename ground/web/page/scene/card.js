// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What draws by a graphics card, and what stands still where there is none: half of three.js, which the first pictures of a robot do without
// there. A chunk of its own; the one file for which the build takes three.js with its renderer.
import {ACESFilmicToneMapping, PCFShadowMap, PMREMGenerator, WebGLRenderer} from 'three';
import {environment} from './sky.js';

function set_up(renderer, points) {
  renderer.toneMapping = ACESFilmicToneMapping;
  renderer.setPixelRatio(points);
  renderer.autoClear = false;
  return renderer;
}

/// Into `canvas`, at the screen's own sharpness: {renderer, mirror}.
export function card_renderer(canvas) {
  const renderer = set_up(new WebGLRenderer({canvas, antialias: true, powerPreference: 'high-performance'}), Math.min(devicePixelRatio, 2));
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = PCFShadowMap;
  return {renderer, mirror: environment(renderer, 128, PMREMGenerator)};
}

/// In a context that is there already and that nobody sees.
export const unseen_renderer = (context) => set_up(new WebGLRenderer({canvas: context.canvas, context}), 1);
