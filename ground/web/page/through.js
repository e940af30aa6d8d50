// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// When the browser is through with what was begun in this turn: without a graphics card a page waits until the processor has drawn it.

/// `then()` is called once after each `soon()`, in order, until `end()`.
export function when_through(then) {
  const {port1, port2} = new MessageChannel();
  port1.onmessage = then;
  return {soon: () => port2.postMessage(null), end: () => port1.close()};
}
