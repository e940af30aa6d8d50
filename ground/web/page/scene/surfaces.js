// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Pictures of surfaces, computed: crumpled foil, solar cells, clouds. The same each time.
import {CanvasTexture, DataTexture, LinearFilter, LinearMipmapLinearFilter, RepeatWrapping, RGBAFormat, SRGBColorSpace} from 'three';

/// Minimal standard generator (Park and Miller): the same picture at each visit.
export class Random {
  constructor(seed) { this.seed = seed; }
  next() {
    this.seed = this.seed * 16807 % 2147483647;
    return (this.seed - 1) / 2147483646;
  }
}

function tiled(data, size) {
  const texture = new DataTexture(data, size, size, RGBAFormat);
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.magFilter = LinearFilter;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 4;
  texture.needsUpdate = true;
  return texture;
}

export function canvas_texture(width, height, draw) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  draw(canvas.getContext('2d'), width, height);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 8;
  return texture;
}

/// Heights of one layer of flat triangles between jittered points, added to `height`: creases stay sharp.
function crumple(height, size, cells, amplitude, random) {
  const points = Array.from({length: cells * cells}, () => [(random.next() - 0.5) * 0.9, (random.next() - 0.5) * 0.9, random.next() * amplitude]);
  const turned = Array.from({length: cells * cells}, () => random.next() < 0.5);
  const seen = new Uint8Array(size * size);
  const wrap = (i, n) => ((i % n) + n) % n;
  const at = (i, j) => {
    const [dx, dy, z] = points[wrap(j, cells) * cells + wrap(i, cells)];
    return [(i + 0.5 + dx) / cells * size, (j + 0.5 + dy) / cells * size, z * size / cells];
  };
  const triangle = (a, b, c) => {
    const area = (b[1] - c[1]) * (a[0] - c[0]) + (c[0] - b[0]) * (a[1] - c[1]);
    const [x0, x1] = [Math.floor(Math.min(a[0], b[0], c[0])), Math.ceil(Math.max(a[0], b[0], c[0]))];
    const [y0, y1] = [Math.floor(Math.min(a[1], b[1], c[1])), Math.ceil(Math.max(a[1], b[1], c[1]))];
    for (let y = y0; y <= y1; ++y) {
      for (let x = x0; x <= x1; ++x) {
        const p = ((b[1] - c[1]) * (x - c[0]) + (c[0] - b[0]) * (y - c[1])) / area, q = ((c[1] - a[1]) * (x - c[0]) + (a[0] - c[0]) * (y - c[1])) / area;
        if (p < -1e-6 || q < -1e-6 || p + q > 1 + 1e-6) continue;
        const place = wrap(y, size) * size + wrap(x, size);
        if (seen[place]) continue;
        seen[place] = 1;
        height[place] += p * a[2] + q * b[2] + (1 - p - q) * c[2];
      }
    }
  };
  for (let j = 0; j < cells; ++j) {
    for (let i = 0; i < cells; ++i) {
      const [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
      if (turned[j * cells + i]) { triangle(a, b, c); triangle(a, c, d); } else { triangle(a, b, d); triangle(b, c, d); }
    }
  }
}

/// The foil of a thermal blanket as a map of normals, with a seam at each half tile.
export function foil_normals(size = 256) {
  const random = new Random(11), height = new Float32Array(size * size), strength = 0.6;
  for (const [cells, amplitude] of [[7, 0.62], [15, 0.5], [31, 0.26]]) crumple(height, size, cells, amplitude, random);
  const seam = (at) => Math.abs(((at / size * 2) % 1) - 0.5);
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const near = Math.min(seam(x), seam(y));
      if (near < 0.012) height[y * size + x] -= (0.012 - near) * 260;
    }
  }
  const data = new Uint8Array(size * size * 4), at = (x, y) => height[((y + size) % size) * size + (x + size) % size];
  for (let y = 0; y < size; ++y) {
    for (let x = 0; x < size; ++x) {
      const dx = (at(x - 1, y) - at(x + 1, y)) * strength, dy = (at(x, y - 1) - at(x, y + 1)) * strength, length = Math.hypot(dx, dy, 1);
      data.set([127.5 + 127.5 * dx / length, 127.5 + 127.5 * dy / length, 127.5 + 127.5 / length, 255], 4 * (y * size + x));
    }
  }
  return tiled(data, size);
}

/// Four octaves of value noise in four channels, tiling.
export function cloud_tile(size = 256) {
  const random = new Random(5), data = new Uint8Array(size * size * 4);
  [5, 9, 6, 11].forEach((first, channel) => {
    const sum = new Float32Array(size * size);
    let amplitude = 1, whole = 0;
    for (let octave = 0, cells = first; octave < 5; ++octave, cells *= 2, amplitude *= 0.55) {
      const lattice = Float32Array.from({length: cells * cells}, () => random.next());
      whole += amplitude;
      for (let y = 0; y < size; ++y) {
        const v = y / size * cells, j = Math.floor(v), b = v - j, fb = b * b * (3 - 2 * b);
        const row = j % cells * cells, next = (j + 1) % cells * cells;
        for (let x = 0; x < size; ++x) {
          const u = x / size * cells, i = Math.floor(u), a = u - i, fa = a * a * (3 - 2 * a), i1 = (i + 1) % cells;
          sum[y * size + x] += amplitude * ((lattice[row + i] * (1 - fa) + lattice[row + i1] * fa) * (1 - fb) + (lattice[next + i] * (1 - fa) + lattice[next + i1] * fa) * fb);
        }
      }
    }
    for (let i = 0; i < size * size; ++i) data[4 * i + channel] = 255 * sum[i] / whole;
  });
  return tiled(data, size);
}

/// Solar cells with clipped corners and two bus bars, each a shade of its own.
export function solar_cells(columns, rows) {
  const random = new Random(3);
  return canvas_texture(columns * 64, rows * 96, (context, width, height) => {
    context.fillStyle = '#0a0d14';
    context.fillRect(0, 0, width, height);
    for (let j = 0; j < rows; ++j) {
      for (let i = 0; i < columns; ++i) {
        const x = i * 64 + 3, y = j * 96 + 3, wide = 58, tall = 90, shade = random.next();
        context.fillStyle = `hsl(${221 + 10 * shade}, ${52 + 12 * shade}%, ${15 + 5 * shade}%)`;
        context.beginPath();
        for (const [px, py] of [[9, 0], [wide - 9, 0], [wide, 9], [wide, tall], [0, tall], [0, 9]]) context.lineTo(x + px, y + py);
        context.fill();
        context.fillStyle = 'rgba(190, 205, 230, .75)';
        for (const bar of [18, 38]) context.fillRect(x + bar, y, 1.6, tall);
        context.fillStyle = 'rgba(170, 190, 225, .22)';
        for (let line = 6; line < tall; line += 6) context.fillRect(x, y + line, wide, 1);
      }
    }
  });
}
