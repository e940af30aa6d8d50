// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// When the next picture is drawn: when something asks for it, and no sooner than the machine can. With a graphics card at the screen's own
// rate; where a processor draws by itself at most 21 a second, and half of that processor is everybody else's.
import {when_through} from '../through.js';

const quick_ms = 10, software_period_ms = 48.5, calm_period_ms = 250, tick_ms = 1000 / 60;
/// Who asks his system for less motion gets four pictures a second.
const calm = matchMedia('(prefers-reduced-motion: reduce)');

export class Pace {
  #waiting = 0;
  #resting = false;
  #wanted_again = false;
  #pause;
  #due_ms;
  #closed = false;
  #drawn;
  #through;

  /// `draw(now_ms)` answers {unfinished, moving}: whether there is more to draw though nothing moved, whether something moves still.
  constructor(draw, software) {
    Object.assign(this, {draw, software});
    this.open();
  }

  soon() {
    if (this.#closed) return;
    if (this.#resting) this.#wanted_again = true;
    else this.#waiting ||= requestAnimationFrame(() => this.#now());
  }

  /// Nothing is drawn until it is opened again.
  close() {
    cancelAnimationFrame(this.#waiting);
    clearTimeout(this.#pause);
    this.#waiting = 0;
    this.#resting = this.#wanted_again = false;
    this.#closed = true;
    this.#through.end();
  }
  open() {
    this.#closed = false;
    this.#through?.end();
    this.#through = when_through(() => {
      const {began_ms, unfinished} = this.#drawn;
      this.#rest(performance.now() - began_ms, calm.matches && !unfinished ? calm_period_ms : this.software ? software_period_ms : 0);
    });
  }

  /// What it took so long for is over: the next picture comes at once.
  anew() {
    clearTimeout(this.#pause);
    this.#resting = this.#wanted_again = false;
    this.#due_ms = undefined;
    this.soon();
  }

  #now() {
    this.#waiting = 0;
    // What drawing itself asks for waits its turn, too: a band that is held would be drawn without a pause.
    this.#resting = true;
    const began_ms = performance.now();
    this.#drawn = {began_ms, unfinished: false};
    this.#through.soon();
    const {unfinished, moving} = this.draw(began_ms);
    this.#drawn.unfinished = unfinished;
    if (unfinished || moving) this.soon();
  }

  /// For half as long as a picture took, the page is everybody else's.
  #rest(took_ms, period_ms) {
    const pause_ms = period_ms ? this.#pause_to(period_ms, took_ms) : took_ms < quick_ms ? 0 : took_ms / 2;
    this.#pause = setTimeout(() => {
      this.#resting = false;
      if (!this.#wanted_again) return;
      this.#wanted_again = false;
      this.soon();
    }, pause_ms);
  }

  /// A browser begins a picture at its next tick only, half a tick after a pause in the mean: without that in the count, pictures of
  /// 47 ms would come each 50 or 66. What one came late, the next one comes earlier.
  #pause_to(period_ms, took_ms) {
    const now_ms = performance.now();
    this.#due_ms = Math.max(now_ms + took_ms / 2, (this.#due_ms ?? now_ms) + period_ms);
    if (this.#due_ms > now_ms + period_ms) this.#due_ms = now_ms + Math.max(took_ms / 2, period_ms - took_ms);
    return Math.max(0, this.#due_ms - now_ms - tick_ms / 2);
  }
}
