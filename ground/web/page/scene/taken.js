// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Where tags must not lie: on the buttons above the picture, the hand, the key, the verdict and the cube.

const those = '.tools, .hand, .key, .inhibited, .cube';

/// Tells `take` their boxes in px of `robot`, at first and when one of them comes, goes or has another size: asked for in between, a browser would
/// lay the page out for the question. Returns what ends it.
export function watch_taken(robot, take) {
  const sizes = new ResizeObserver(() => {
    const home = robot.getBoundingClientRect();
    take([...robot.querySelectorAll(those)].map((node) => {
      const box = node.getBoundingClientRect();
      return {left: box.left - home.left, right: box.right - home.left, top: box.top - home.top, bottom: box.bottom - home.top};
    }));
  });
  const look = () => {
    sizes.disconnect();
    for (const node of [robot, ...robot.querySelectorAll(those)]) sizes.observe(node);
  };
  const parts = new MutationObserver(look);
  parts.observe(robot, {childList: true});
  look();
  return () => {
    sizes.disconnect();
    parts.disconnect();
  };
}
