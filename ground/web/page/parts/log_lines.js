// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// The lines of a log that goes on.

export const most_lines = 2000;

/// The newest lines before those that are here already; alone where they do not reach these, as nobody then knows what is between, and
/// where a replay has gone back.
export function with_newest(found, answer) {
  if (!answer.packets.length) return found;
  if (answer.packets[0].number < found.packets[0]?.number) return answer;
  const fresh = new Set(answer.packets.map((one) => one.number));
  if (!found.packets.some((one) => fresh.has(one.number))) return answer;
  const packets = [...answer.packets, ...found.packets.filter((one) => !fresh.has(one.number))];
  return packets.length > most_lines ? {packets: packets.slice(0, most_lines), before: packets[most_lines - 1].number} : {packets, before: found.before};
}
