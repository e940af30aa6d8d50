// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Motion between samples: what is shown glides from where it stood when the newest sample came to that sample, in as long as samples are
// apart. So it is one sample late, and never ahead of what was measured. Without I/O and clock: the caller says what time it is.

const usual_period_ms = 100, shortest_period_ms = 15, longest_period_ms = 400;
const settled = 1e-5;

export class Motion {
  shown = [];
  #from = [];
  #to = null;
  #came_ms = 0;
  #period_ms = usual_period_ms;

  /// The newest sample of all joints, as it came at `now_ms`; a value that is not known is not finite.
  take(sample, now_ms) {
    if (this.#to && sample.every((value, i) => value === this.#to[i] || (!Number.isFinite(value) && !Number.isFinite(this.#to[i])))) return;
    if (!this.#to) {
      this.shown = [...sample];
    } else {
      this.at(now_ms);
      const apart_ms = now_ms - this.#came_ms;
      // A pause says nothing of how far apart samples are.
      if (apart_ms < longest_period_ms) this.#period_ms += 0.3 * (Math.max(shortest_period_ms, apart_ms) - this.#period_ms);
    }
    this.#from = this.shown.map((value, i) => Number.isFinite(value) ? value : sample[i]);
    this.#to = [...sample];
    this.#came_ms = now_ms;
  }

  /// What is to be shown at `now_ms`: values between two samples, the newest one after a period without another.
  at(now_ms) {
    if (!this.#to) return this.shown;
    const part = Math.max(0, Math.min(1, (now_ms - this.#came_ms) / this.#period_ms));
    this.shown = this.#to.map((to, i) => this.#from[i] + part * (to - this.#from[i]));
    return this.shown;
  }

  /// Whether there is a way to go still.
  moving() {
    return this.#to !== null && this.shown.some((value, i) => Math.abs(value - this.#to[i]) > settled);
  }

  /// Another time, a replay or the way back from it: the next sample is where it stands, not where it goes to.
  forget() {
    this.#to = null;
  }
}
