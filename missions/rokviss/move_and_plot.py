# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# Moves the robot of the mission rokviss and plots what was commanded beside what was measured.
#
#     hirosco run rokviss                             # in another terminal
#     hirosco export python rokviss --to out
#     PYTHONPATH=out python3 missions/rokviss/move_and_plot.py [plot.svg]
#
# Each `# %%` begins a cell for editors that run Python by cells. Nothing but Python 3.9 is needed; where matplotlib is
# installed, the plot is matplotlib's.

# %% Connect
import sys

from hirosco_rokviss import ArgumentError, CommandFailed, Spacecraft

plot_file = sys.argv[1] if len(sys.argv) > 1 else "move_and_plot.svg"
craft = Spacecraft()
arm = craft.manipulator
craft.wait_until(lambda: craft.mode and arm.state, what="the supervisor told nothing")
print(f"mode {craft.mode}; manipulator {arm.state}, {arm.configuration}")


# %% Bring the craft into the mode where the robot moves on its own: one telecommand, from whatever mode it is in
if (craft.mode, arm.configuration, arm.state) != ("standalone", "STANDALONE", "Operational"):
    craft.supervisor.set_mode("standalone")
    craft.wait_until(lambda: craft.mode == "standalone" and arm.state == "Operational")
    print(f"mode {craft.mode}; manipulator {arm.state}, {arm.configuration}")

# %% What cannot be: a value outside its range is not even sent, a wrong mode is the supervisor's to refuse
try:
    arm.move_to(5.0, 1.7, 2.0)
except ArgumentError as error:
    print(f"not sent: {error}")
try:
    arm.run_script(1)
except CommandFailed as refusal:
    print(f"refused: {refusal}")

# %% Move, and record: 4713 comes every 50 ms and has the measured and the commanded angles
goal = (-1.20, 2.00)              # away from the rail
if abs(arm.hk_4713()["CUR_VALUES.POSITION"][0] - goal[0]) < 0.1:
    goal = (-0.85, 1.70)          # it was there already
with arm.record(4713) as reports:
    request = arm.move_to(*goal, duration=2.0)
    arm.hk_4713()                 # one more after the end
for verification in request.verifications:
    print(f"{verification.after_s * 1e3:7.1f} ms  {verification.stage}")

# %% Compare
times = [report.time_s - reports[0].time_s for report in reports]
measured = [report["CUR_VALUES.POSITION"] for report in reports]
commanded = [report["DES_POSITION"] for report in reports]
error = max(abs(m - c) for both in zip(measured, commanded) for m, c in zip(*both))
print(f"{len(reports)} reports; at the end ({measured[-1][0]:.4f}, {measured[-1][1]:.4f}) rad for "
      f"({goal[0]}, {goal[1]}); never more than {error * 1e3:.1f} mrad from what was commanded")
curves = [(f"joint {joint + 1} {what}", [one[joint] for one in angles], colour, line_width)
          for joint, colours in enumerate((("#9fc3ea", "#174a80"), ("#f0bd96", "#8f3f10")))
          for what, angles, colour, line_width in (("commanded", commanded, colours[0], 6),
                                                   ("measured", measured, colours[1], 1.5))]


# %% Plot
def svg(times, curves, width=800, height=420, margin=56):
    """Curves over time as the text of an SVG file."""
    low, high = (limit(value for _, values, _, _ in curves for value in values) for limit in (min, max))
    low, high = low - 0.05 * (high - low or 1), high + 0.05 * (high - low or 1)

    def place(t, value):
        return (f"{margin + (width - 2 * margin) * t / (times[-1] or 1):.1f},"
                f"{height - margin - (height - 2 * margin) * (value - low) / (high - low):.1f}")

    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
             f'font-size="13"><rect width="100%" height="100%" fill="white"/>',
             f'<text x="{width / 2}" y="{height - 12}" text-anchor="middle">time in s</text>',
             f'<text x="16" y="{margin - 16}">angle in rad</text>']
    for step in range(6):
        t, value = times[-1] * step / 5, low + (high - low) * step / 5
        x, y = place(t, value).split(",")
        lines += [f'<line x1="{margin}" x2="{width - margin}" y1="{y}" y2="{y}" stroke="#ddd"/>',
                  f'<text x="{margin - 6}" y="{y}" text-anchor="end" dy="4">{value:.2f}</text>',
                  f'<text x="{x}" y="{height - margin + 18}" text-anchor="middle">{t:.1f}</text>']
    for column, (name, values, colour, line_width) in enumerate(curves):
        points = " ".join(place(t, value) for t, value in zip(times, values))
        x, y = margin + 94 + 160 * column, margin - 20
        lines += [f'<g stroke="{colour}" stroke-width="{line_width}" fill="none"><polyline points="{points}"/>'
                  f'<line x1="{x - 22}" x2="{x - 6}" y1="{y}" y2="{y}"/></g>',
                  f'<text x="{x}" y="{y + 4}">{name}</text>']
    return "\n".join([*lines, "</svg>\n"])


try:
    from matplotlib import pyplot
except ImportError:
    with open(plot_file, "w", encoding="utf-8") as file:
        file.write(svg(times, curves))
else:
    for name, values, colour, line_width in curves:
        pyplot.plot(times, values, color=colour, linewidth=line_width, label=name)
    pyplot.xlabel("time in s")
    pyplot.ylabel("angle in rad")
    pyplot.legend()
    pyplot.savefig(plot_file)
print(f"plot: {plot_file}")

# %% The end: the robot holds where it is; modes and states stay until somebody changes them
craft.close()
