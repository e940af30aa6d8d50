// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Triangles as a processor draws them best, where there is no graphics card: a browser's own way is a card that is imitated, with programs, threads
// and a copy of the whole picture. Here corners are lit once, rows are filled between two edges, and only the rows that were drawn upon are cleared.
// Coordinates in px from the upper left, depths from -1 (near) to 1 (far). Without I/O.

const far = 1, corner_numbers = 9, least_depth = 1e-6, least_area = 1e-4;

export class Raster {
  #edge = new Float64Array(7);
  #light = new Float64Array(14);

  constructor() {
    this.corners = new Float64Array(0);
    this.#size(0, 0);
  }

  #size(width, height) {
    this.image = width && height ? new ImageData(width, height) : null;
    Object.assign(this, {width, height, depth: new Float32Array(width * height).fill(far), points: this.image ? new Uint32Array(this.image.data.buffer) : new Uint32Array(0)});
    this.#forget();
  }

  #forget() { Object.assign(this, {left: Infinity, top: Infinity, right: -1, bottom: -1, first_row: Infinity, last_row: -1}); }

  /// Nothing is drawn any more, on a picture of this size.
  begin(width, height) {
    if (width !== this.width || height !== this.height) return this.#size(width, height);
    if (this.last_row >= this.first_row) {
      this.depth.fill(far, this.first_row * width, (this.last_row + 1) * width);
      this.points.fill(0, this.first_row * width, (this.last_row + 1) * width);
    }
    this.#forget();
  }

  /// What was drawn upon since: {left, top, width, height}; null when nothing was.
  drawn() {
    return this.right >= this.left && this.bottom >= this.top ? {left: this.left, top: this.top, width: this.right - this.left + 1, height: this.bottom - this.top + 1} : null;
  }

  /// Room for corners of nine numbers: x, y, depth (all NaN: behind the eye), red, green, blue (0 to 255), opacity (0 to 1), u, v.
  room(count) {
    if (this.corners.length < corner_numbers * count) this.corners = new Float64Array(corner_numbers * count);
    return this.corners;
  }

  /// Triangles of `index`, or of each three corners. `side`: 1 those that face the eye, -1 the others, 0 both. `write`: '' hides only, 'opaque',
  /// 'blend', or 'darkest', of which the most that falls on a point counts. `test` and `keep` depth; `lean` slopes of it and `nearer` are taken off.
  triangles(index, count, {write = 'opaque', side = 1, test = true, keep = true, lean = 0, nearer = 0, texture = null}) {
    const {corners: c} = this, quick = keep && test && !lean && !nearer && !texture && (write === 'opaque' || write === '');
    for (let i = 0; i + 2 < count; i += 3) {
      const a = corner_numbers * (index ? index[i] : i), b = corner_numbers * (index ? index[i + 1] : i + 1), d = corner_numbers * (index ? index[i + 2] : i + 2);
      const area = (c[b] - c[a]) * (c[d + 1] - c[a + 1]) - (c[d] - c[a]) * (c[b + 1] - c[a + 1]);
      // y goes down: what turns left in space turns right here. What is behind the eye is no number, and neither.
      if (!(side === 1 ? area < -least_area : side === -1 ? area > least_area : Math.abs(area) > least_area)) continue;
      if (quick && write) this.#opaque(a, b, d, 1 / area);
      else if (quick) this.#hiding(a, b, d, 1 / area);
      else this.#any(a, b, d, 1 / area, write, test, keep, lean, nearer, texture);
    }
  }

  /// The edges of a triangle from above to below; its first row and the one after its last in 0 and 1.
  #edges(a, b, d) {
    const {corners: c, height} = this, e = this.#edge;
    let t = a, m = b, l = d, s = 0;
    if (c[m + 1] < c[t + 1]) { s = t; t = m; m = s; }
    if (c[l + 1] < c[t + 1]) { s = t; t = l; l = s; }
    if (c[l + 1] < c[m + 1]) { s = m; m = l; l = s; }
    const xt = c[t], yt = c[t + 1], xm = c[m], ym = c[m + 1], xl = c[l], yl = c[l + 1];
    const from = Math.max(0, Math.ceil(yt - 0.5)), to = Math.min(height, Math.ceil(yl - 0.5));
    if (from >= to) return false;
    e[0] = from;
    e[1] = to;
    e[2] = ym;
    e[3] = (xl - xt) / (yl - yt);
    e[4] = xt - yt * e[3];
    // The two short edges: slope of the upper and of the lower one, as x at the middle corner.
    e[5] = ym > yt ? (xm - xt) / (ym - yt) : 0;
    e[6] = yl > ym ? (xl - xm) / (yl - ym) : 0;
    this.middle_x = xm;
    if (from < this.first_row) this.first_row = from;
    if (to - 1 > this.last_row) this.last_row = to - 1;
    return true;
  }

  #hiding(a, b, d, inverse) {
    if (!this.#edges(a, b, d)) return;
    const {corners: c, width, depth, middle_x} = this, e = this.#edge, from = e[0], to = e[1], ym = e[2], long = e[3], begin = e[4], upper = e[5], lower = e[6];
    const ax = c[a], ay = c[a + 1], z0 = c[a + 2], bx = c[b] - ax, by = c[b + 1] - ay, dx = c[d] - ax, dy = c[d + 1] - ay, zb = c[b + 2] - z0, zd = c[d + 2] - z0;
    const z_x = (zb * dy - zd * by) * inverse, z_y = (zd * bx - zb * dx) * inverse;
    for (let y = from; y < to; ++y) {
      const at = y + 0.5, one = begin + at * long, other = middle_x + (at - ym) * (at < ym ? upper : lower);
      const x0 = Math.max(0, Math.ceil((one < other ? one : other) - 0.5)), x1 = Math.min(width, Math.ceil((one < other ? other : one) - 0.5));
      let z = z0 + z_x * (x0 + 0.5 - ax) + z_y * (at - ay);
      for (let i = y * width + x0, end = y * width + x1; i < end; ++i, z += z_x) if (z < depth[i]) depth[i] = z;
    }
  }

  #opaque(a, b, d, inverse) {
    if (!this.#edges(a, b, d)) return;
    const {corners: c, width, depth, points, middle_x} = this, e = this.#edge, from = e[0], to = e[1], ym = e[2], long = e[3], begin = e[4], upper = e[5], lower = e[6];
    const ax = c[a], ay = c[a + 1], bx = (c[b] - ax) * inverse, by = (c[b + 1] - ay) * inverse, dx = (c[d] - ax) * inverse, dy = (c[d + 1] - ay) * inverse;
    const z0 = c[a + 2], zb = c[b + 2] - z0, zd = c[d + 2] - z0, z_x = zb * dy - zd * by, z_y = zd * bx - zb * dx;
    const r0 = c[a + 3], rb = c[b + 3] - r0, rd = c[d + 3] - r0, r_x = rb * dy - rd * by, r_y = rd * bx - rb * dx;
    const g0 = c[a + 4], gb = c[b + 4] - g0, gd = c[d + 4] - g0, g_x = gb * dy - gd * by, g_y = gd * bx - gb * dx;
    const b0 = c[a + 5], bb = c[b + 5] - b0, bd = c[d + 5] - b0, b_x = bb * dy - bd * by, b_y = bd * bx - bb * dx;
    let left = width, right = -1;
    for (let y = from; y < to; ++y) {
      const at = y + 0.5, one = begin + at * long, other = middle_x + (at - ym) * (at < ym ? upper : lower);
      const x0 = Math.max(0, Math.ceil((one < other ? one : other) - 0.5)), x1 = Math.min(width, Math.ceil((one < other ? other : one) - 0.5));
      if (x0 >= x1) continue;
      if (x0 < left) left = x0;
      if (x1 > right) right = x1;
      const px = x0 + 0.5 - ax, py = at - ay;
      let z = z0 + z_x * px + z_y * py, r = r0 + r_x * px + r_y * py, g = g0 + g_x * px + g_y * py, blue = b0 + b_x * px + b_y * py;
      for (let i = y * width + x0, end = y * width + x1; i < end; ++i) {
        if (z <= depth[i]) {
          depth[i] = z;
          points[i] = 0xff000000 | (blue & 255) << 16 | (g & 255) << 8 | r & 255;
        }
        z += z_x; r += r_x; g += g_x; blue += b_x;
      }
    }
    this.#touch(left, right, from, to);
  }

  #touch(left, right, from, to) {
    if (right <= left) return;
    if (left < this.left) this.left = left;
    if (right - 1 > this.right) this.right = right - 1;
    if (from < this.top) this.top = from;
    if (to - 1 > this.bottom) this.bottom = to - 1;
  }

  #any(a, b, d, inverse, write, test, keep, lean, nearer, texture) {
    if (!this.#edges(a, b, d)) return;
    const {corners: c, width, depth, middle_x} = this, e = this.#edge, from = e[0], to = e[1], ym = e[2], long = e[3], begin = e[4], upper = e[5], lower = e[6], k = this.#light;
    const ax = c[a], ay = c[a + 1], bx = (c[b] - ax) * inverse, by = (c[b + 1] - ay) * inverse, dx = (c[d] - ax) * inverse, dy = (c[d + 1] - ay) * inverse;
    // The slopes of depth, colour, opacity, u and v along x and y; what hides and what darkens has no colour.
    const slopes = !write || write === 'darkest' ? 1 : texture ? 7 : 5;
    for (let n = 0; n < slopes; ++n) {
      const nb = c[b + 2 + n] - c[a + 2 + n], nd = c[d + 2 + n] - c[a + 2 + n];
      k[2 * n] = nb * dy - nd * by;
      k[2 * n + 1] = nd * bx - nb * dx;
    }
    const leaned = lean * (Math.max(Math.abs(k[0]), Math.abs(k[1])) + least_depth) + nearer;
    const level = texture?.level(Math.max(Math.abs(k[10]), Math.abs(k[11])), Math.max(Math.abs(k[12]), Math.abs(k[13])));
    const {points} = this, dark = write === 'darkest' ? Math.round(255 * c[a + 6]) << 24 : 0;
    let left = width, right = -1;
    for (let y = from; y < to; ++y) {
      const at = y + 0.5, one = begin + at * long, other = middle_x + (at - ym) * (at < ym ? upper : lower);
      const x0 = Math.max(0, Math.ceil((one < other ? one : other) - 0.5)), x1 = Math.min(width, Math.ceil((one < other ? other : one) - 0.5));
      if (x0 >= x1) continue;
      if (x0 < left) left = x0;
      if (x1 > right) right = x1;
      const px = x0 + 0.5 - ax, py = at - ay, first = y * width + x0, end = y * width + x1;
      let z = c[a + 2] + k[0] * px + k[1] * py - leaned;
      if (dark) {
        for (let i = first; i < end; ++i, z += k[0]) if (points[i] === 0 && z <= depth[i]) points[i] = dark;
        continue;
      }
      for (let i = first; i < end; ++i, z += k[0]) {
        if (test && z > depth[i]) continue;
        if (keep) depth[i] = z;
        if (!write) continue;
        const x = px + i - first;
        const r = c[a + 3] + k[2] * x + k[3] * py, g = c[a + 4] + k[4] * x + k[5] * py, blue = c[a + 5] + k[6] * x + k[7] * py, o = c[a + 6] + k[8] * x + k[9] * py;
        if (!texture) this.#blend(i, r, g, blue, o);
        else {
          const t = level.at(c[a + 7] + k[10] * x + k[11] * py, c[a + 8] + k[12] * x + k[13] * py);
          this.#blend(i, r * t[0] / 255, g * t[1] / 255, blue * t[2] / 255, write === 'opaque' ? 1 : o * t[3] / 255);
        }
      }
    }
    if (write) this.#touch(left, right, from, to);
  }

  /// Over what is there, which is kept as colours that are not multiplied by their opacity.
  #blend(i, r, g, b, o) {
    const {points} = this, before = points[i];
    if (before === 0 || o >= 1) {
      points[i] = Math.round(255 * Math.min(1, o)) << 24 | (b & 255) << 16 | (g & 255) << 8 | r & 255;
      return;
    }
    const rest = (before >>> 24) / 255 * (1 - o), all = o + rest;
    if (!(all > 0)) return;
    const own = o / all, other = rest / all;
    points[i] = Math.round(255 * all) << 24 | (b * own + (before >>> 16 & 255) * other & 255) << 16 | (g * own + (before >>> 8 & 255) * other & 255) << 8 | r * own + (before & 255) * other & 255;
  }

  /// One point wide, above everything.
  line(x0, y0, x1, y1, [r, g, b], opacity = 1) {
    const steps = Math.min(4096, Math.ceil(Math.max(Math.abs(x1 - x0), Math.abs(y1 - y0))));
    if (!Number.isFinite(steps)) return;
    for (let i = 0; i <= steps; ++i) {
      const x = Math.floor(x0 + (x1 - x0) * i / (steps || 1)), y = Math.floor(y0 + (y1 - y0) * i / (steps || 1));
      if (x < 0 || y < 0 || x >= this.width || y >= this.height) continue;
      this.#blend(y * this.width + x, r, g, b, opacity);
      this.first_row = Math.min(this.first_row, y);
      this.last_row = Math.max(this.last_row, y);
      this.#touch(x, x + 1, y, y + 1);
    }
  }
}

/// A picture on a surface, in sizes that halve: small on the screen it is taken from a small one.
export class Texture {
  #levels;

  constructor(canvas) {
    const first = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    this.#levels = [new Level(first.data, first.width, first.height)];
    while (Math.min(this.#levels.at(-1).width, this.#levels.at(-1).height) > 2) this.#levels.push(this.#levels.at(-1).half());
  }

  /// For a surface of which a point on the screen is `u` wide and `v` tall, of 1.
  level(u, v) {
    const [{width, height}] = this.#levels, points = Math.max(u * width, v * height);
    return this.#levels[Math.max(0, Math.min(this.#levels.length - 1, Math.round(Math.log2(Math.max(points, 1)))))];
  }
}

class Level {
  #found = [0, 0, 0, 0];

  constructor(data, width, height) { Object.assign(this, {data, width, height}); }

  half() {
    const [width, height] = [this.width >> 1, this.height >> 1], data = new Uint8ClampedArray(4 * width * height);
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        const parts = [0, 1, this.width, this.width + 1].map((step) => 4 * (2 * y * this.width + 2 * x + step)), opaque = parts.reduce((sum, at) => sum + this.data[at + 3], 0);
        for (let n = 0; n < 3; ++n) data[4 * (y * width + x) + n] = opaque ? parts.reduce((sum, at) => sum + this.data[at + n] * this.data[at + 3], 0) / opaque : 0;
        data[4 * (y * width + x) + 3] = opaque / 4;
      }
    }
    return new Level(data, width, height);
  }

  /// Between the four points around a place; v goes up.
  at(u, v) {
    const x = Math.max(0, Math.min(this.width - 1, u * this.width - 0.5)), y = Math.max(0, Math.min(this.height - 1, (1 - v) * this.height - 0.5));
    const left = Math.floor(x), top = Math.floor(y), right = Math.min(this.width - 1, left + 1), below = Math.min(this.height - 1, top + 1), p = x - left, q = y - top;
    const [a, b, c, d] = [top * this.width + left, top * this.width + right, below * this.width + left, below * this.width + right];
    for (let n = 0; n < 4; ++n) {
      this.#found[n] = (this.data[4 * a + n] * (1 - p) + this.data[4 * b + n] * p) * (1 - q) + (this.data[4 * c + n] * (1 - p) + this.data[4 * d + n] * p) * q;
    }
    return this.#found;
  }
}
