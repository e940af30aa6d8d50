// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Holds the WebSocket beside the page's thread: a hidden or busy tab never leaves the gateway with a full queue. What comes is
// handed on in batches, so that a burst of 10,000 events costs the page one redraw. The next batch waits until the page is through with
// the last one and had as much time for itself: a page slower than the telemetry shows less often, never later and later.

const batch_ms = 10;
const longest_wait_ms = 1000;

let socket = null;
let waiting = [];
let timer = 0;
let wait_ms = 250;
let url = '';

let page_is_busy = false;

function hand_on_soon(after_ms = batch_ms) {
  if (waiting.length && !page_is_busy) timer ||= setTimeout(hand_on, after_ms);
}

function hand_on() {
  timer = 0;
  page_is_busy = true;
  postMessage({kind: 'messages', list: waiting});
  waiting = [];
}

function connect() {
  socket = new WebSocket(url);
  socket.onopen = () => {
    wait_ms = 250;
    postMessage({kind: 'open'});
  };
  socket.onmessage = ({data}) => {
    try {
      waiting.push(JSON.parse(data));
    } catch {
      return;
    }
    hand_on_soon();
  };
  socket.onclose = ({code}) => {
    postMessage({kind: 'closed', code});
    setTimeout(connect, wait_ms);
    wait_ms = Math.min(longest_wait_ms, wait_ms * 2);
  };
}

onmessage = ({data}) => {
  if (data.kind === 'connect') {
    url = data.url;
    connect();
  } else if (data.kind === 'taken') {
    page_is_busy = false;
    hand_on_soon(Math.max(batch_ms, data.took_ms));
  } else if (data.kind === 'send' && socket?.readyState === WebSocket.OPEN) {
    socket.send(JSON.stringify(data.message));
  }
};
