#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""bench/same_octets.py ONE OTHER: whether two simulated flights said and did the same, line by line. ONE and OTHER are files of what
`hirosco simulate --octets` printed, of its `--trace`, or of trace.txt of a planned flight.

Each begins with what its octets rest on (docs/adr/0182). Where that differs in more than the version of HIROSCO, which is what is compared, the octets may differ
and nothing is wrong: that is said, and they are not compared. Ends with 0: the same; 1: another; 2: not to be compared."""
import pathlib
import sys

MARKS = ("# simulated: ", "0 simulated ")
COMPARED = "hirosco"          # whose octets are looked at
SAME, OTHER, REFUSED = range(3)


def origin(lines):
    """What the first line says, and the lines behind it; None where it says nothing, as files of earlier versions."""
    for mark in MARKS:
        if lines and lines[0].startswith(mark):
            return dict(word.partition("=")[::2] for word in lines[0][len(mark):].split()), lines[1:]
    return None, lines


def compare(one, other, names=("one", "other")):
    """How it ended, and what is to be said of it."""
    (first, lines), (second, others) = origin(one), origin(other)
    for who, said in zip(names, (first, second)):
        # Earlier versions said nothing: who has both at hand knows whether they flew on one computer.
        if said is None and first != second:
            return judged(lines, others, names, f"{who} does not say what its octets rest on")
    if first is not None:
        differ = [f"{key} {first.get(key, 'none')} and {second.get(key, 'none')}" for key in sorted({*first, *second} - {COMPARED})
                  if first.get(key) != second.get(key)]
        if differ:
            return REFUSED, (f"not compared: {names[0]} and {names[1]} rest on {'; '.join(differ)}. The same octets are promised of one version "
                             "of each, on one architecture, of one mission and seed: simulate one of them anew there")
    return judged(lines, others, names, "")


def judged(lines, others, names, remark):
    remark = f" ({remark})" if remark else ""
    if not lines and not others:
        return REFUSED, "not compared: there is nothing in either"
    if lines == others:
        return SAME, f"the same octets: {len(lines)} lines{remark}"
    number = next((n for n, pair in enumerate(zip(lines, others)) if pair[0] != pair[1]), min(len(lines), len(others)))
    told = [f"differs at line {number + 1} of {len(lines)} and {len(others)}{remark}:"]
    for who, each in zip(names, (lines, others)):
        told.append(f"  {who}: {each[number] if number < len(each) else 'has ended'}")
    return OTHER, "\n".join(told)


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return REFUSED
    texts = []
    for path in sys.argv[1:]:
        try:
            texts.append(pathlib.Path(path).read_text(encoding="utf-8").splitlines())
        except (OSError, UnicodeDecodeError) as why:
            print(f"same_octets: {path} cannot be read: {why}", file=sys.stderr)
            return REFUSED
    how, told = compare(*texts, sys.argv[1:])
    print(told)
    return how


if __name__ == "__main__":
    sys.exit(main())
